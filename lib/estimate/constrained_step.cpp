#include "estimate/constrained_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "estimate/ipopt.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A step of the unknowns that can move: |R (y - about) + q|^2 under the constraints.
class Subproblem : public IpoptProblemOf {
 public:
  Subproblem(const std::vector<SmoothConstraint>& constraints, const Coordinates& coordinates,
             std::vector<Index> open, VectorXd all)
      : constraints_(constraints),
        coordinates_(coordinates),
        open_(std::move(open)),
        all_(std::move(all)) {
    least = VectorXd::Zero(static_cast<Index>(constraints.size()));
    most = least;
    for (std::size_t c = 0; c < constraints.size(); ++c)
      if (!constraints[c].equality) most[static_cast<Index>(c)] = 1e300;
    // Of one size, whatever their units.
    for (const SmoothConstraint& c : constraints) {
      const double slope = in_steps(c, coordinates_, all_).slope.norm();
      weight_.push_back(std::isfinite(slope) && slope > 0 ? 1 / slope : 1);
    }
  }
  VectorXd inner() const {
    VectorXd at(static_cast<Index>(open_.size()));
    for (Index k = 0; k < at.size(); ++k) {
      const Index i = open_[static_cast<std::size_t>(k)];
      at[k] = coordinates_.inner(static_cast<std::size_t>(i), all_[i]);
    }
    return at;
  }
  VectorXd outer(const VectorXd& at) const {
    VectorXd x = all_;
    for (Index k = 0; k < at.size(); ++k) {
      const Index i = open_[static_cast<std::size_t>(k)];
      x[i] = coordinates_.outer(static_cast<std::size_t>(i), at[k]);
    }
    return x;
  }
  // Of one constraint, by the unknowns that can move.
  Taylor constraint(std::size_t c, const VectorXd& at) const {
    const Taylor one = in_steps(constraints_[c], coordinates_, outer(at));
    const double w = weight_[c];
    return {w * one.value, w * one.slope(open_), w * one.curvature(open_, open_)};
  }
  double value(const VectorXd& at) const { return (R * (at - about) + q).squaredNorm(); }
  void evaluate(const VectorXd& at) override {
    r = R * (at - about) + q;
    J = R;
  }
  bool curves() const override { return true; }
  void constrain(const VectorXd& at) override {
    g.resize(least.size());
    A.resize(least.size(), at.size());
    for (Index c = 0; c < g.size(); ++c) {
      const Taylor one = constraint(static_cast<std::size_t>(c), at);
      g[c] = one.value;
      A.row(c) = one.slope;
    }
  }
  void bend(const VectorXd& at, const VectorXd& factor, MatrixXd& H) override {
    for (Index c = 0; c < factor.size(); ++c)
      if (factor[c] != 0) H += factor[c] * constraint(static_cast<std::size_t>(c), at).curvature;
  }

  MatrixXd R;
  VectorXd q, about;

 private:
  const std::vector<SmoothConstraint>& constraints_;
  const Coordinates& coordinates_;
  std::vector<Index> open_;
  VectorXd all_;
  std::vector<double> weight_;
};

// The exact end of a subproblem: Newton's method on the conditions of Karush, Kuhn and Tucker with
// what is taken to bind, to which is added what that breaks and from which is taken what it pulls
// at.
class ActiveSet {
 public:
  ActiveSet(Subproblem& p, std::vector<bool> binds)
      : p_(p),
        binds_(std::move(binds)),
        held_(Eigen::VectorXi::Zero(p.y.size())),
        factor_(VectorXd::Zero(p.least.size())) {
    for (std::size_t c = 0; c < binds_.size(); ++c)
      binds_[c] = binds_[c] || is_equality(static_cast<Index>(c));
  }
  // Near the point where Ipopt ended.
  ActiveSet(Subproblem& p, const IpoptEnd& end)
      : ActiveSet(p, std::vector<bool>(static_cast<std::size_t>(p.least.size()))) {
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
  // Sets the subproblem's y, and true, where it comes to a minimum that is no worse than `most`.
  bool run(double most) {
    const auto passes = 4 + 2 * (p_.least.size() + p_.y.size());
    for (Index pass = 0; pass < passes; ++pass) {
      if (!solve()) return false;
      if (add_broken() || release()) continue;
      if (!is_minimum() || !(value(y_) <= most * (1 + 1e-9) + 1e-15)) return false;
      p_.y = y_.cwiseMax(p_.low).cwiseMin(p_.high);
      return true;
    }
    return false;
  }
  const std::vector<bool>& binds() const { return binds_; }

 private:
  static constexpr double kRounding = 1e-11;
  bool is_equality(Index c) const { return p_.most[c] == 0; }
  double value(const VectorXd& y) const { return p_.value(y); }

  bool solve() {
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
    for (int round = 0; round < 20; ++round) {
      MatrixXd K = MatrixXd::Zero(n + rows + kept, n + rows + kept);
      VectorXd right = VectorXd::Zero(K.rows());
      K.topLeftCorner(n, n) = 2 * p_.R.transpose() * p_.R;
      right.head(n) = -2 * p_.R.transpose() * (p_.R * (y_ - p_.about) + p_.q);
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
      if (step.head(n).cwiseAbs().maxCoeff() > kRounding) continue;
      factor_.setZero();
      for (Index b = 0; b < rows; ++b) factor_[of_[b]] = factor[b];
      return true;
    }
    return false;
  }
  // Whether the curvature along what nothing binds is that of a minimum.
  bool is_minimum() const {
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
  bool add_broken() {
    double most = 10 * kRounding;
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
  bool release() {
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

  Subproblem& p_;
  std::vector<bool> binds_;
  Eigen::VectorXi held_;  // -1: at its lower bound; 1: at its upper one
  VectorXd factor_, y_, of_bounds_;
  MatrixXd curvature_, across_;
  std::vector<Index> of_, bounds_;
};

}  // namespace

std::optional<VectorXd> constrained_step(const std::vector<SmoothConstraint>& constraints,
                                         const Coordinates& coordinates,
                                         const std::vector<Index>& open, const VectorXd& x,
                                         const MatrixXd& J, const VectorXd& r, const StepBox& box,
                                         std::vector<bool>& binds) {
  Subproblem p(constraints, coordinates, open, x);
  p.about = p.inner();
  p.y = p.about;
  p.low = box.low.cwiseMax((p.y.array() - box.reach).matrix());
  p.high = box.high.cwiseMin((p.y.array() + box.reach).matrix());
  const Index n = J.cols();
  MatrixXd padded = MatrixXd::Zero(std::max(J.rows(), n), n);
  padded.topRows(J.rows()) = J;
  VectorXd turned = VectorXd::Zero(padded.rows());
  turned.head(r.size()) = r;
  const Eigen::HouseholderQR<MatrixXd> qr(padded);
  turned.applyOnTheLeft(qr.householderQ().adjoint());
  const MatrixXd R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  // Ipopt's tolerances are for problems of size one. What the residuals do not see stays.
  const double size = std::max(R.norm(), 1e-300);
  p.R = MatrixXd::Zero(2 * n, n);
  p.R.topRows(n) = R / size;
  p.R.bottomRows(n).diagonal().setConstant(1e-7);
  p.q = VectorXd::Zero(2 * n);
  p.q.head(n) = turned.head(n) / size;
  // What bound before mostly does again, and a few of Newton's steps find that out.
  const VectorXd from = p.y;
  binds.resize(constraints.size());
  p.constrain(from);
  bool kept = p.g.allFinite();
  for (Index c = 0; c < p.g.size(); ++c) {
    const bool broken = p.g[c] < 0;
    kept = kept && !broken && p.most[c] != 0;
    if (broken) binds[static_cast<std::size_t>(c)] = true;
  }
  ActiveSet near(p, binds);
  if (near.run(kept ? p.value(from) : std::numeric_limits<double>::infinity())) {
    binds = near.binds();
    return p.outer(p.y);
  }
  p.y = from;
  const IpoptEnd end = minimise_by_ipopt(p, 500);
  if (!end.converged || !p.y.allFinite()) return std::nullopt;
  ActiveSet exact(p, end);
  if (exact.run(p.value(p.y))) {
    binds = exact.binds();
    return p.outer(p.y);
  }
  for (std::size_t c = 0; c < constraints.size(); ++c)
    if (broken_by(constraints[c], p.constraint(c, p.y)) > kKept) return std::nullopt;
  return p.outer(p.y);
}

}  // namespace hapsim
