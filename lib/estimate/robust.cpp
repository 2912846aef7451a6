#include "estimate/robust.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/median.h"
#include "estimate/normal_inverse.h"

namespace hapsim {
namespace {

// 95 % efficiency on normal errors (Holland and Welsch, Commun. Statist. A6, 1977).
constexpr double kHuber = 1.345, kTukey = 4.685;
constexpr int kMostRounds = 50;

// Derivative of weight(r) r.
double slope(RobustLoss loss, double size) {
  if (loss == RobustLoss::kNone) return 1;
  if (loss == RobustLoss::kHuber) return size <= kHuber ? 1 : 0;
  const double q = size / kTukey;
  return q >= 1 ? 0 : (1 - q * q) * (1 - 5 * q * q);
}

double median_size(const Eigen::VectorXd& r) {
  std::vector<double> size(static_cast<std::size_t>(r.size()));
  for (std::size_t i = 0; i < size.size(); ++i) size[i] = std::abs(r[static_cast<Eigen::Index>(i)]);
  return upper_median(std::move(size));
}

}  // namespace

RobustLoss robust_loss(const std::string& name) {
  if (name == "huber") return RobustLoss::kHuber;
  return name == "tukey" ? RobustLoss::kTukey : RobustLoss::kNone;
}

double robust_weight(RobustLoss loss, double size) {
  size = std::abs(size);
  if (loss == RobustLoss::kNone || size == 0) return 1;
  if (loss == RobustLoss::kHuber) return std::min(1.0, kHuber / size);
  const double q = size / kTukey;
  return q >= 1 ? 0 : (1 - q * q) * (1 - q * q);
}

RobustResult minimise_robustly(const std::vector<Unknown>& start, const ResidualFunction& residuals,
                               RobustLoss loss, const LeastSquaresOptions& options,
                               const Minimiser& minimiser) {
  RobustResult result;
  std::vector<Unknown> unknowns = start;
  const auto solve = [&](RobustLoss now) {
    const ResidualFunction weighted = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                          Eigen::MatrixXd* J) {
      residuals(x, r, J);
      if (result.weights.size() != r.size()) result.weights = Eigen::VectorXd::Ones(r.size());
      const Eigen::VectorXd root = result.weights.cwiseSqrt();
      r = r.cwiseProduct(root);
      if (J != nullptr) *J = root.asDiagonal() * *J;
    };
    for (int round = 0; round < kMostRounds; ++round) {
      ++result.rounds;
      result.fit = minimiser(unknowns, weighted, options);
      if (!result.fit.converged) return;
      for (std::size_t i = 0; i < unknowns.size(); ++i)
        unknowns[i].value = result.fit.x[static_cast<Eigen::Index>(i)];
      Eigen::VectorXd r;
      residuals(result.fit.x, r, nullptr);
      result.scale = std::max(1.0, median_size(r) / 0.6745);
      Eigen::VectorXd next(r.size());
      for (Eigen::Index i = 0; i < r.size(); ++i) next[i] = robust_weight(now, r[i] / result.scale);
      const double change = r.size() == 0 ? 0 : (next - result.weights).cwiseAbs().maxCoeff();
      result.weights = next;
      if (change < 1e-4) return;
    }
    result.fit.converged = false;
    result.fit.message = "the weights of the robust loss do not settle";
  };
  if (loss == RobustLoss::kTukey) solve(RobustLoss::kHuber);
  if (loss != RobustLoss::kTukey || result.fit.converged) solve(loss);
  if (!result.fit.converged) return result;

  result.discounted = static_cast<int>((result.weights.array() < 0.5).count());
  if (loss == RobustLoss::kNone) return result;
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
  residuals(result.fit.x, r, &J);
  const auto n = static_cast<double>(r.size()), m = static_cast<double>(unknowns.size());
  if (n < 1.5 * m) {
    result.fit.converged = false;
    result.fit.message = "too few residuals for a robust fit";
    return result;
  }
  // Huber (1981): (J'J)^-1 of the unweighted problem times K^2 mean(psi^2) / mean(psi')^2.
  double squares = 0, flatness = 0;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const double size = std::abs(r[i]) / result.scale;
    squares += std::pow(robust_weight(loss, size) * size, 2);
    flatness += slope(loss, size);
  }
  const double mean = flatness / n;
  const double correction = 1 + m / n * (1 - mean) / std::max(mean, 1e-3);
  const double factor =
      correction * correction * squares / std::max(1.0, n - m) / std::max(mean * mean, 1e-6);
  std::vector<int> open;
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (!result.fit.at_bound[i]) open.push_back(static_cast<int>(i));
  result.fit.covariance.setZero();
  result.spread = factor * result.scale * result.scale;
  if (open.empty()) return result;
  result.fit.covariance(open, open) =
      factor * result.scale * result.scale * normal_inverse(J(Eigen::all, open));
  return result;
}

}  // namespace hapsim
