#include "estimate/constrained_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

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
    return {one.value, one.slope(open_), one.curvature(open_, open_)};
  }
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
};

// The exact end of a subproblem near the point where Ipopt ended: Newton's method on the conditions
// of Karush, Kuhn and Tucker with what binds there, to which is added what that breaks and from
// which is taken what it pulls at.
class Polish {
 public:
  Polish(Subproblem& p, const IpoptEnd& end)
      : p_(p), binds_(static_cast<std::size_t>(p.least.size())), held_(p.y.size()) {
    p.constrain(p.y);
    for (Index c = 0; c < p.g.size(); ++c) {
      const double slope = std::max(p.A.row(c).norm(), 1e-300);
      binds_[static_cast<std::size_t>(c)] =
          is_equality(c) || std::abs(end.of_constraints[c]) * slope > p.g[c] / slope;
    }
    for (Index i = 0; i < p.y.size(); ++i)
      held_[i] = end.of_low[i] > p.y[i] - p.low[i] ? -1 : end.of_high[i] > p.high[i] - p.y[i];
    factor_ = -end.of_constraints;
  }
  // Sets the subproblem's y where it comes to an end that is no worse; else the interior point
  // stays.
  void run() {
    const auto most = 4 + 2 * (p_.least.size() + p_.y.size());
    for (Index pass = 0; pass < most; ++pass) {
      if (!solve()) return;
      if (add_broken() || release()) continue;
      if (value(y_) <= value(p_.y) * (1 + 1e-9) + 1e-15)
        p_.y = y_.cwiseMax(p_.low).cwiseMin(p_.high);
      return;
    }
  }

 private:
  static constexpr double kRounding = 1e-11;
  bool is_equality(Index c) const { return p_.most[c] == 0; }
  double value(const VectorXd& y) const { return (p_.R * (y - p_.about) + p_.q).squaredNorm(); }

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
  VectorXd y_, factor_, of_bounds_;
  std::vector<Index> of_, bounds_;
};

}  // namespace

std::optional<VectorXd> constrained_step(const std::vector<SmoothConstraint>& constraints,
                                         const Coordinates& coordinates,
                                         const std::vector<Index>& open, const VectorXd& x,
                                         const MatrixXd& J, const VectorXd& r, const StepBox& box) {
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
  const IpoptEnd end = minimise_by_ipopt(p, 500);
  if (!end.converged || !p.y.allFinite()) return std::nullopt;
  Polish(p, end).run();
  return p.outer(p.y);
}

}  // namespace hapsim
