#include "estimate/step_active_set.h"

#include <Eigen/Dense>
#include <algorithm>
#include <functional>
#include <utility>

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStepRounding = 1e-11;

}  // namespace

StepActiveSet::StepActiveSet(StepProblem& p, std::vector<bool> binds)
    : StepActiveSet(p, std::move(binds), Eigen::VectorXi::Zero(p.y.size()),
                    VectorXd::Zero(p.least.size())) {}

StepActiveSet::StepActiveSet(StepProblem& p, std::vector<bool> binds, Eigen::VectorXi held,
                             VectorXd factor)
    : p_(p), binds_(std::move(binds)), held_(std::move(held)), factor_(std::move(factor)) {
  for (std::size_t c = 0; c < binds_.size(); ++c)
    binds_[c] = binds_[c] || is_equality(static_cast<Index>(c));
}

StepActiveSet::StepActiveSet(StepProblem& p, const IpoptEnd& end)
    : StepActiveSet(p, std::vector<bool>(static_cast<std::size_t>(p.least.size()))) {
  p.constrain(p.y);
  for (Index c = 0; c < p.g.size(); ++c) {
    const double slope = std::max(p.A.row(c).norm(), 1e-300);
    if (std::abs(end.of_constraints[c]) * slope > p.g[c] / slope)
      binds_[static_cast<std::size_t>(c)] = true;
  }
  for (Index i = 0; i < p.y.size(); ++i)
    held_[i] = end.of_low[i] > p.y[i] - p.low[i] ? -1 : end.of_high[i] > p.high[i] - p.y[i];
  factor_ = -end.of_constraints;
}

bool StepActiveSet::run(double most) {
  const auto passes = 4 + 2 * (p_.least.size() + p_.y.size());
  for (Index pass = 0; pass < passes; ++pass) {
    if (!solve()) return false;
    if (add_broken() || release()) continue;
    if (!is_minimum() || !(p_.value(y_) <= most + 1e-9 * std::abs(most) + 1e-15)) return false;
    p_.y = y_.cwiseMax(p_.low).cwiseMin(p_.high);
    return true;
  }
  return false;
}

bool StepActiveSet::solve() {
  const Index n = p_.y.size();
  of_.clear();
  for (std::size_t c = 0; c < binds_.size(); ++c)
    if (binds_[c]) of_.push_back(static_cast<Index>(c));
  bounds_.clear();
  for (Index i = 0; i < n; ++i)
    if (held_[i] != 0) bounds_.push_back(i);
  const auto rows = static_cast<Index>(of_.size()), kept = static_cast<Index>(bounds_.size());
  y_ = p_.y;
  VectorXd factor = factor_(of_);
  const MatrixXd bend = p_.curvature();
  for (int round = 0; round < 20; ++round) {
    MatrixXd K = MatrixXd::Zero(n + rows + kept, n + rows + kept);
    VectorXd right = VectorXd::Zero(K.rows());
    K.topLeftCorner(n, n) = bend;
    right.head(n) = -p_.slope(y_);
    for (Index b = 0; b < rows; ++b) {
      const Taylor g = p_.constraint(static_cast<std::size_t>(of_[b]), y_);
      K.topLeftCorner(n, n) -= factor[b] * g.curvature;
      K.block(0, n + b, n, 1) = -g.slope;
      K.block(n + b, 0, 1, n) = g.slope.transpose();
      right[n + b] = -g.value;
    }
    for (Index k = 0; k < kept; ++k) {
      const Index i = bounds_[k];
      K(i, n + rows + k) = -1;
      K(n + rows + k, i) = 1;
      right[n + rows + k] = (held_[i] < 0 ? p_.low[i] : p_.high[i]) - y_[i];
    }
    const VectorXd step = K.completeOrthogonalDecomposition().solve(right);
    if (!step.allFinite()) return false;
    curvature_ = K.topLeftCorner(n, n);
    across_ = K.bottomLeftCorner(rows + kept, n).transpose();
    y_ += step.head(n);
    factor = step.segment(n, rows);
    of_bounds_ = step.tail(kept);
    if (step.head(n).cwiseAbs().maxCoeff() > kStepRounding) continue;
    factor_.setZero();
    for (Index b = 0; b < rows; ++b) factor_[of_[b]] = factor[b];
    return true;
  }
  return false;
}

// Whether the curvature along what nothing binds is that of a minimum.
bool StepActiveSet::is_minimum() const {
  const Index n = y_.size();
  MatrixXd free = MatrixXd::Identity(n, n);
  if (across_.cols() > 0) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(across_);
    free = (qr.householderQ() * free).rightCols(n - qr.rank()).eval();
  }
  if (free.cols() == 0) return true;
  const MatrixXd bend = free.transpose() * curvature_ * free;
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(bend, Eigen::EigenvaluesOnly).eigenvalues()[0] >
         -1e-12;
}

// Whether something is broken that did not bind.
bool StepActiveSet::add_broken() {
  double most = 10 * kStepRounding;
  std::function<void()> add;
  for (std::size_t c = 0; c < binds_.size(); ++c) {
    if (binds_[c]) continue;
    const Taylor g = p_.constraint(c, y_);
    const double by = -g.value / std::max(g.slope.norm(), 1e-300);
    if (!(by > most)) continue;
    most = by;
    add = [this, c] { binds_[c] = true; };
  }
  for (Index i = 0; i < y_.size(); ++i) {
    const double below = p_.low[i] - y_[i], above = y_[i] - p_.high[i];
    if (held_[i] != 0 || !(std::max(below, above) > most)) continue;
    most = std::max(below, above);
    add = [this, i, below] { held_[i] = below > 0 ? -1 : 1; };
  }
  if (add) add();
  return static_cast<bool>(add);
}

// Whether something was held that pulled the wrong way.
bool StepActiveSet::release() {
  double least = -1e-14;
  std::function<void()> free;
  for (const Index c : of_) {
    if (is_equality(c)) continue;
    const double pull = factor_[c] * p_.constraint(static_cast<std::size_t>(c), y_).slope.norm();
    if (!(pull < least)) continue;
    least = pull;
    free = [this, c] { binds_[static_cast<std::size_t>(c)] = false; };
  }
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const Index i = bounds_[k];
    const double pull = -held_[i] * of_bounds_[static_cast<Index>(k)];
    if (!(pull < least)) continue;
    least = pull;
    free = [this, i] { held_[i] = 0; };
  }
  if (free) free();
  return static_cast<bool>(free);
}

}  // namespace hapsim
