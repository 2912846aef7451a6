#include "estimate/regularised.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "linalg/sparse_cholesky.h"

namespace hapsim {
namespace {

// The penalty's matrix on a pattern that stays: lower triangle, columns compressed.
class PenaltyMatrix {
 public:
  explicit PenaltyMatrix(const FieldProblem& p) : problem_(p) {
    const int n = static_cast<int>(p.J.cols());
    std::vector<std::vector<int>> below(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) below[i].push_back(i);
    for (const auto& [a, b] : p.edges) below[std::min(a, b)].push_back(std::max(a, b));
    matrix_.size = n;
    matrix_.column_start.assign(1, 0);
    for (auto& rows : below) {
      std::sort(rows.begin(), rows.end());
      matrix_.row.insert(matrix_.row.end(), rows.begin(), rows.end());
      matrix_.column_start.push_back(static_cast<int>(matrix_.row.size()));
    }
    matrix_.value.assign(matrix_.row.size(), 0);
    for (const auto& [a, b] : p.edges) {
      const int column = std::min(a, b);
      const auto begin = matrix_.row.begin() + matrix_.column_start[column];
      const auto end = matrix_.row.begin() + matrix_.column_start[column + 1];
      place_.push_back(std::lower_bound(begin, end, std::max(a, b)) - matrix_.row.begin());
    }
    cholesky_ = std::make_unique<SparseCholesky>(matrix_, 1);
  }
  // R^-1 J' for the edges' factors q (on the squared weights).
  Eigen::MatrixXd inverse_times_J(const Eigen::VectorXd& q) {
    std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
    for (Eigen::Index i = 0; i < problem_.node_weight.size(); ++i)
      diagonal(i) += problem_.node_weight[i] * problem_.node_weight[i];
    for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
      const auto i = static_cast<Eigen::Index>(e);
      const double w = q[i] * problem_.edge_weight[i] * problem_.edge_weight[i];
      diagonal(problem_.edges[e][0]) += w;
      diagonal(problem_.edges[e][1]) += w;
      matrix_.value[static_cast<std::size_t>(place_[e])] -= w;
    }
    if (!cholesky_->factorise(matrix_)) return {};
    return cholesky_->solve(problem_.J.transpose());
  }

 private:
  double& diagonal(Eigen::Index i) { return matrix_.value[matrix_.column_start[i]]; }
  const FieldProblem& problem_;
  SymmetricSparse matrix_;
  std::vector<std::ptrdiff_t> place_;
  std::unique_ptr<SparseCholesky> cholesky_;
};

// Error of data left out group by group: (I - H_gg)^-1 of their residuals.
double left_out(const FieldProblem& p, const Eigen::MatrixXd& hat,
                const Eigen::VectorXd& residual) {
  std::map<int, std::vector<Eigen::Index>> groups;
  for (std::size_t i = 0; i < p.group.size(); ++i)
    groups[p.group[i]].push_back(static_cast<Eigen::Index>(i));
  double squares = 0;
  for (const auto& [number, rows] : groups) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    const Eigen::MatrixXd own = Eigen::MatrixXd::Identity(n, n) - hat(rows, rows);
    squares += own.ldlt().solve(residual(rows)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(residual.size()));
}

FieldSolution with_weight(const FieldProblem& p, const Eigen::MatrixXd& G,
                          const Eigen::MatrixXd& JG, double weight) {
  const Eigen::Index n = p.data.size();
  const Eigen::MatrixXd S = JG / weight + Eigen::MatrixXd::Identity(n, n);
  const Eigen::LDLT<Eigen::MatrixXd> solver(S);
  FieldSolution s;
  s.weight = weight;
  s.m = G * solver.solve(p.data) / weight;
  const Eigen::VectorXd residual = p.data - p.J * s.m;
  s.misfit = std::sqrt(residual.squaredNorm() / static_cast<double>(n));
  const Eigen::MatrixXd hat =
      Eigen::MatrixXd::Identity(n, n) - solver.solve(Eigen::MatrixXd::Identity(n, n));
  s.held_out = left_out(p, hat, residual);
  return s;
}

}  // namespace

FieldSolution solve_field(const FieldProblem& p, Penalty penalty) {
  // Jumps well above kEdge (2 % of the modulus, for m is its logarithm) are left sharp. Of weights
  // whose errors differ by less than the twentieth that kAlike allows, the smoothest is taken.
  constexpr double kEdge = 0.02, kAlike = 1.05;
  constexpr int kReweightings = 6, kWeights = 13;
  PenaltyMatrix matrix(p);
  const auto edges = static_cast<Eigen::Index>(p.edges.size());
  const Eigen::VectorXd plain = Eigen::VectorXd::Ones(edges);
  const Eigen::MatrixXd G = matrix.inverse_times_J(plain);
  const Eigen::MatrixXd JG = p.J * G;
  // Weights from nearly no penalty to nearly nothing but it, by the eigenvalues of J R^-1 J': the
  // largest belong to what the penalty hardly holds, as a common constant.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(JG, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double high = 10 * values[values.size() - 1];
  const double low = std::max(1e-14 * high, 1e-2 * values[values.size() / 2]);
  std::vector<FieldSolution> tried;
  for (int k = 0; k < kWeights; ++k) {
    const double weight = low * std::pow(high / low, k / (kWeights - 1.0));
    FieldSolution s = with_weight(p, G, JG, weight);
    if (penalty == Penalty::kTotalVariation) {
      for (int round = 0; round < kReweightings; ++round) {
        Eigen::VectorXd q(edges);
        for (Eigen::Index e = 0; e < edges; ++e) {
          const auto& [a, b] = p.edges[static_cast<std::size_t>(e)];
          const double jump = p.edge_weight[e] * (s.m[a] - s.m[b]);
          q[e] = kEdge / std::sqrt(jump * jump + kEdge * kEdge);
        }
        const Eigen::MatrixXd own = matrix.inverse_times_J(q);
        s = with_weight(p, own, p.J * own, weight);
      }
    }
    tried.push_back(std::move(s));
  }
  double least = tried.front().held_out;
  for (const FieldSolution& s : tried) least = std::min(least, s.held_out);
  for (std::size_t k = tried.size(); k-- > 0;)
    if (tried[k].held_out <= kAlike * least) return tried[k];
  return tried.back();
}

}  // namespace hapsim
