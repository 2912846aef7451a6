#include "estimate/field_posterior.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"
#include "base/parallel.h"
#include "estimate/left_out.h"
#include "estimate/penalty_matrix.h"

namespace hapsim {
namespace {

// Variance of a weighted jump under the prior alone, were all edges alike: of total variation the
// fixed point u = sqrt(u + kEdge^2) / (weight kEdge).
double jump_variance(double weight, Penalty penalty) {
  if (penalty == Penalty::kSmooth) return 1 / weight;
  const double a = weight * kEdge;
  return (1 + std::sqrt(1 + 4 * a * a * kEdge * kEdge)) / (2 * a * a);
}
// The weight of that variance.
double weight_of_jumps(double variance, Penalty penalty) {
  return penalty == Penalty::kSmooth ? 1 / variance
                                     : std::sqrt(variance + kEdge * kEdge) / (variance * kEdge);
}

double factor_of(double square) {
  return kEdge / std::sqrt(square + kEdge * kEdge);
}

struct NormalField {
  Eigen::VectorXd mean, variance;
  Eigen::MatrixXd times_J;  // C J': unknowns x data
  double log_score = 0;     // of the data left out
};

// `m`: where to begin.
NormalField normal_field(const FieldProblem& p, PenaltyMatrix& matrix, const Eigen::VectorXd& m,
                         double weight, Penalty penalty) {
  constexpr int kRounds =
      4;  // from the prior's own factors all but the last digits stand after two
  const Eigen::Index n = p.data.size();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  const bool smooth = penalty == Penalty::kSmooth;
  const double start = jump_variance(weight, penalty);
  Eigen::VectorXd q =
      edge_factors(p, m, [&](double t) { return smooth ? 1 : factor_of(t * t + start); });
  NormalField f;
  for (int round = 0; round < (smooth ? 1 : kRounds); ++round) {
    const Eigen::MatrixXd PJ = matrix.inverse_times_J(q) / weight;
    const PenaltyMatrix::Inverse inverse = matrix.inverse();
    const Eigen::LLT<Eigen::MatrixXd> S(p.J * PJ + one);
    const Eigen::MatrixXd W = S.matrixL().solve(PJ.transpose());
    f.mean = PJ * S.solve(p.data);
    f.variance = inverse.diagonal / weight - W.colwise().squaredNorm().transpose();
    f.variance = f.variance.cwiseMax(0);
    if (round + 1 == (smooth ? 1 : kRounds)) {
      f.times_J = S.solve(PJ.transpose()).transpose();
      f.log_score = left_out(p, one - S.solve(one), p.data - p.J * f.mean).log_score;
      break;
    }
    for (std::size_t e = 0; e < p.edges.size(); ++e) {
      const auto i = static_cast<Eigen::Index>(e);
      const auto& [a, b] = p.edges[e];
      const double jump = f.mean[a] - f.mean[b];
      const double prior =
          (inverse.diagonal[a] + inverse.diagonal[b] - 2 * inverse.beside[i]) / weight;
      const double left = std::max(0.0, prior - (W.col(a) - W.col(b)).squaredNorm());
      q[i] = factor_of(p.edge_weight[i] * p.edge_weight[i] * (jump * jump + left));
    }
  }
  return f;
}

// The largest weight whose prior is as wide as asked.
double largest_weight(const FieldProblem& p, PenaltyMatrix& matrix, Penalty penalty) {
  if (p.least_spread <= 0) return std::numeric_limits<double>::infinity();
  constexpr int kRounds = 5;  // to less than the weight matters
  const auto edges = static_cast<Eigen::Index>(p.edges.size());
  const auto spread = [&](double weight) {
    const double q = penalty == Penalty::kSmooth ? 1 : factor_of(jump_variance(weight, penalty));
    matrix.set(Eigen::VectorXd::Constant(edges, q));
    const Eigen::VectorXd diagonal = matrix.inverse().diagonal;
    return std::sqrt(median({diagonal.begin(), diagonal.end()}) / weight);
  };
  // Of total variation the spread goes with one over the weight where jumps are beyond kEdge, and
  // with one over its root elsewhere, as of the smooth penalty.
  const double power = penalty == Penalty::kSmooth ? 2 : 1;
  double weight = weight_of_jumps(p.least_spread * p.least_spread, penalty);
  for (int round = 0; round < kRounds; ++round)
    weight *= std::pow(spread(weight) / p.least_spread, power);
  return weight;
}

// Rows b_i of `A` = C J': the moments of the rows of A J by quadratic forms in the space of the
// data, sum_j (b_i J_j)^2 f(x_j) = b_i J diag(f) J' b_i'.
Eigen::VectorXd spread_of_rows(const Eigen::MatrixXd& A, const Eigen::MatrixXd& J,
                               const std::vector<Vec3>& place) {
  const Eigen::Index n = J.cols();
  Eigen::MatrixXd x(n, 3);
  for (Eigen::Index j = 0; j < n; ++j) x.row(j) = place[static_cast<std::size_t>(j)].transpose();
  x.rowwise() -= x.colwise().mean().eval();
  const auto moment = [&](const Eigen::VectorXd& f) -> Eigen::VectorXd {
    const Eigen::MatrixXd Q = J * f.asDiagonal() * J.transpose();
    return (A * Q).cwiseProduct(A).rowwise().sum();
  };
  const Eigen::VectorXd sum = moment(Eigen::VectorXd::Ones(n));
  Eigen::VectorXd squares = moment(x.rowwise().squaredNorm());
  for (int k = 0; k < 3; ++k) squares -= 2 * x.col(k).cwiseProduct(moment(x.col(k)));
  squares += x.rowwise().squaredNorm().cwiseProduct(sum);
  Eigen::VectorXd length(n);
  for (Eigen::Index i = 0; i < n; ++i)
    length[i] = sum[i] > 0 ? std::sqrt(std::max(0.0, squares[i] / sum[i]))
                           : std::numeric_limits<double>::infinity();
  return length;
}

}  // namespace

FieldPosterior field_posterior(const FieldProblem& p, const FieldSolution& solution,
                               Penalty penalty, const std::vector<Vec3>& place, int threads) {
  constexpr double kUnlikely = 5;  // of a log score below the best's: not asked further
  PenaltyMatrix matrix(p);
  const double largest = largest_weight(p, matrix, penalty);
  double best = -std::numeric_limits<double>::infinity();
  bool beyond = false;
  for (const FieldCandidate& c : solution.tried) {
    if (c.weight <= largest) best = std::max(best, c.log_score);
    beyond = beyond || c.weight > largest;
  }
  const Eigen::VectorXd& chosen = solution.field().m;
  std::vector<std::pair<const Eigen::VectorXd*, double>> asked;  // where to begin, weight
  for (const FieldCandidate& c : solution.tried)
    if (c.weight <= largest && c.log_score > best - kUnlikely) asked.emplace_back(&c.m, c.weight);
  if (beyond) asked.emplace_back(&chosen, largest);
  std::vector<NormalField> fields(asked.size());
  in_parallel(asked.size(), threads, [&](std::size_t k) {
    PenaltyMatrix own(p);
    fields[k] = normal_field(p, own, *asked[k].first, asked[k].second, penalty);
  });
  const NormalField& likeliest = *std::max_element(
      fields.begin(), fields.end(),
      [](const NormalField& a, const NormalField& b) { return a.log_score < b.log_score; });
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(p.J.cols());
  double total = 0;
  for (const NormalField& f : fields) {
    const double share = std::exp(f.log_score - likeliest.log_score);
    variance += share * (f.variance + (f.mean - chosen).cwiseAbs2());
    total += share;
  }
  return {(variance / total).cwiseSqrt(), spread_of_rows(likeliest.times_J, p.J, place)};
}

}  // namespace hapsim
