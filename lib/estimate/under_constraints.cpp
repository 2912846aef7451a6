#include "estimate/under_constraints.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "estimate/constrained_step.h"
#include "estimate/feasible.h"
#include "estimate/normal_inverse.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Search {
 public:
  Search(const std::vector<Unknown>& start, const std::vector<SmoothConstraint>& constraints,
         const ResidualFunction& residuals, const LeastSquaresOptions& options)
      : start_(start),
        constraints_(constraints),
        residuals_(residuals),
        options_(options),
        coordinates_(start_),
        x_(static_cast<Index>(start.size())),
        low_(x_.size()),
        high_(x_.size()) {
    for (Index i = 0; i < x_.size(); ++i) {
      const auto u = static_cast<std::size_t>(i);
      x_[i] = std::clamp(start[u].value, start[u].lower, start[u].upper);
      low_[i] = coordinates_.low(u);
      high_[i] = coordinates_.high(u);
      if (low_[i] < high_[i]) open_.push_back(i);
    }
    // What the unknowns that can move do not change is kept or not, whatever they are.
    for (std::size_t c = 0; c < constraints.size(); ++c) {
      const Taylor g = in_steps(constraints[c], coordinates_, x_);
      if (g.slope(open_).isZero(0) && g.curvature(open_, open_).isZero(0)) continue;
      moving_.push_back(constraints[c]);
      number_.push_back(c);
    }
  }

  UnderConstraints run() {
    result_.active.assign(constraints_.size(), false);
    result_.fit.at_bound.assign(start_.size(), false);
    result_.fit.undetermined.assign(start_.size(), false);
    LeastSquaresResult& fit = result_.fit;
    if (!look(x_)) {
      fit.message = "the start gives no finite forces";
      fit.x = x_;
      return std::move(result_);
    }
    if (options_.max_iterations == 0)
      fit.converged = true;
    else if (begin())
      descend();
    tell();
    return std::move(result_);
  }

 private:
  VectorXd inner(const VectorXd& x) const {
    VectorXd y(static_cast<Index>(open_.size()));
    for (Index k = 0; k < y.size(); ++k) {
      const Index i = open_[static_cast<std::size_t>(k)];
      y[k] = coordinates_.inner(static_cast<std::size_t>(i), x[i]);
    }
    return y;
  }
  bool keeps(const VectorXd& x) const {
    return std::all_of(constraints_.begin(), constraints_.end(), [&](const SmoothConstraint& c) {
      return broken_by(c, in_steps(c, coordinates_, x)) <= kKept;
    });
  }
  // r and J by y at x; false where there are none. J is asked for at once: nearly all steps are
  // good.
  bool look(const VectorXd& x) {
    try {
      residuals_(x, r_, &J_);
    } catch (const Error& error) {  // a law without an equilibrium there
      if (error.code() != ExitCode::kNoConvergence) throw;
      return false;
    }
    for (Index i = 0; i < x.size(); ++i)
      J_.col(i) *= coordinates_.slope(static_cast<std::size_t>(i), x[i]);
    x_ = x;
    return std::isfinite(r_.squaredNorm());
  }
  // No further than `box` away; false where there is none.
  bool step(double box, VectorXd& best) {
    MatrixXd J = J_(Eigen::all, open_);
    VectorXd r = r_;
    if (bend_.size() > 0) with_bend(J, r);
    const auto found = constrained_step(moving_, coordinates_, open_, x_, J, r,
                                        {low_(open_), high_(open_), box}, binds_);
    if (found) best = *found;
    return found.has_value();
  }
  // |r + J d|^2 + d' S d as |q + R d|^2 but for a constant, where that has a minimum.
  void with_bend(MatrixXd& J, VectorXd& r) const {
    const Eigen::LLT<MatrixXd> llt(J.transpose() * J + bend_);
    if (llt.info() != Eigen::Success || !(llt.rcond() > 1e-10)) return;
    VectorXd q = J.transpose() * r;
    llt.matrixL().solveInPlace(q);
    r = std::move(q);
    J = llt.matrixU();
  }
  // Where much is left and the constraints hold it, steps without the residuals' own curvature
  // S = sum r_i d2r_i shrink by a constant factor only. S from the changes of J along the steps, by
  // the least symmetric change that each asks for (Dennis, Gay and Welsch, ACM Trans. Math. Softw.
  // 7, 1981, of what the change is; Powell, in Nonlinear Programming, 1970, of the update).
  void learn_bend(const VectorXd& moved, const MatrixXd& last_J) {
    const auto n = static_cast<Index>(open_.size());
    if (bend_.size() == 0) bend_ = MatrixXd::Zero(n, n);
    const VectorXd lacks =
        (J_(Eigen::all, open_) - last_J(Eigen::all, open_)).transpose() * r_ - bend_ * moved;
    const double square = moved.squaredNorm();
    if (square == 0) return;
    bend_ += (lacks * moved.transpose() + moved * lacks.transpose()) / square -
             lacks.dot(moved) / (square * square) * moved * moved.transpose();
  }

  // To a point that keeps the constraints: the best of the linearised residuals where there is one.
  bool begin() {
    if (keeps(x_)) return true;
    VectorXd best;
    if (!open_.empty() && enough_freedom() && step(1e300, best) && keeps(best)) {
      if (look(best)) return true;
    }
    const std::optional<VectorXd> point = feasible_point(start_, constraints_);
    if (!point) {
      result_.fit.message = "no point keeps all constraints";
      return false;
    }
    if (!look(*point)) result_.fit.message = "the start gives no finite forces";
    return result_.fit.message.empty();
  }
  bool enough_freedom() const {
    const auto equal = std::count_if(moving_.begin(), moving_.end(),
                                     [](const SmoothConstraint& c) { return c.equality; });
    return equal < static_cast<std::ptrdiff_t>(open_.size());
  }

  void descend() {
    LeastSquaresResult& fit = result_.fit;
    constexpr double kTiny = 1e-5, kRounding = 1e-13;
    double sum = r_.squaredNorm(), box = 2, before = 0;
    if (open_.empty() || !enough_freedom()) {
      fit.converged = true;
      fit.message = "the constraints leave nothing to fit";
      return;
    }
    while (fit.iterations < options_.max_iterations) {
      ++fit.iterations;
      VectorXd best;
      const bool bent = bend_.size() > 0;
      if (!step(box, best)) {
        if (box < 1e-6) break;
        box /= 4;
        continue;
      }
      const VectorXd moved = inner(best) - inner(x_);
      const double length = moved.cwiseAbs().maxCoeff();
      // Steps shrink by a constant factor where much is left: so far the end is still away.
      const double shrink = before > 0 ? std::min(0.9, length / before) : 0.5;
      const bool near = length * std::max(1.0, shrink / (1 - shrink)) < options_.step_tolerance;
      if (near && bent) {  // an end is one without S as well
        bend_.resize(0, 0);
        before = 0;
        continue;
      }
      if (near) {
        fit.converged = true;
        fit.message = "converged";
        return;
      }
      const VectorXd last = x_, last_r = r_;
      const MatrixXd last_J = J_;
      if (!look(best) || r_.squaredNorm() > sum * (1 + 1e-13)) {
        x_ = last;
        r_ = last_r;
        J_ = last_J;
        bend_.resize(0, 0);
        box = length / 4;
        // A refused tiny step is the floor of rounding.
        if (length > kTiny || bent) continue;
        fit.converged = true;
        fit.message = "converged";
        return;
      }
      const double fall = sum - r_.squaredNorm();
      sum = r_.squaredNorm();
      if (length < kTiny && fall <= kRounding * sum && !bent) {
        fit.converged = true;
        fit.message = "converged";
        return;
      }
      constexpr double kNear = 0.5;  // steps beyond which the curvature is another
      if (length < kNear) learn_bend(moved, last_J);
      before = length;
      if (length > 0.9 * box) box *= 2;
      if (options_.watch && !options_.watch(sum)) {
        fit.stopped = true;
        fit.message = "interrupted";
        return;
      }
    }
    fit.message = fit.iterations < options_.max_iterations
                      ? "no step keeps the constraints and decreases the error"
                      : "too many iterations";
  }

  // What binds, and what it leaves.
  void tell() {
    LeastSquaresResult& fit = result_.fit;
    const Index m = x_.size();
    fit.x = x_;
    fit.sum_of_squares = r_.squaredNorm();
    const VectorXd gradient = 2 * J_.transpose() * r_;
    std::vector<VectorXd> binding;
    std::vector<std::size_t> of;  // the constraint of a row; none of a bound
    constexpr double kNear = 1e-7;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Taylor g = in_steps(moving_[k], coordinates_, x_);
      const double size = std::max(g.slope.norm(), 1e-300);
      result_.active[number_[k]] = moving_[k].equality || g.value <= kNear * size;
      if (!result_.active[number_[k]]) continue;
      binding.emplace_back(g.slope / size);
      of.push_back(number_[k]);
    }
    constexpr std::size_t kBound = static_cast<std::size_t>(-1);
    for (Index i = 0; i < m; ++i) {
      const auto u = static_cast<std::size_t>(i);
      const double y = coordinates_.inner(u, x_[i]);
      fit.at_bound[u] = y <= low_[i] + kNear || y >= high_[i] - kNear;
      if (!fit.at_bound[u]) continue;
      binding.emplace_back(VectorXd::Unit(m, i));
      of.push_back(kBound);
    }
    MatrixXd A(m, static_cast<Index>(binding.size()));
    for (Index b = 0; b < A.cols(); ++b) A.col(b) = binding[static_cast<std::size_t>(b)];
    const VectorXd factor =
        A.cols() == 0 ? VectorXd() : VectorXd(A.completeOrthogonalDecomposition().solve(gradient));
    result_.multiplier = VectorXd::Zero(static_cast<Index>(constraints_.size()));
    result_.worth = result_.multiplier;
    for (Index b = 0; b < A.cols(); ++b) {
      const std::size_t c = of[static_cast<std::size_t>(b)];
      if (c == kBound) continue;
      const Taylor g = in_steps(constraints_[c], coordinates_, x_);
      result_.multiplier[static_cast<Index>(c)] = factor[b] / std::max(g.slope.norm(), 1e-300);
      MatrixXd others(m, A.cols() - 1);
      others << A.leftCols(b), A.rightCols(A.cols() - 1 - b);
      const MatrixXd J = J_ * free_of(others);
      const VectorXd pull = J.transpose() * r_;
      result_.worth[static_cast<Index>(c)] = pull.dot(normal_inverse(J) * pull);
    }
    VectorXd slope(m);
    for (Index i = 0; i < m; ++i) slope[i] = coordinates_.slope(static_cast<std::size_t>(i), x_[i]);
    const auto active = std::count(result_.active.begin(), result_.active.end(), true);
    result_.settled = A.leftCols(active).transpose() * slope.cwiseInverse().asDiagonal();
    const MatrixXd free = free_of(A);
    result_.directions = slope.asDiagonal() * free;
    fit.covariance = MatrixXd::Zero(m, m);
    if (free.cols() == 0) return;
    const MatrixXd J = J_ * free;
    fit.covariance = result_.directions * normal_inverse(J) * result_.directions.transpose();
    const Index k = free.cols();
    MatrixXd padded = MatrixXd::Zero(std::max(J.rows(), k), k);
    padded.topRows(J.rows()) = J;
    const MatrixXd R = Eigen::HouseholderQR<MatrixXd>(padded).matrixQR().topRows(k);
    const Eigen::JacobiSVD<MatrixXd> svd(MatrixXd(R.triangularView<Eigen::Upper>()),
                                         Eigen::ComputeFullV);
    const VectorXd& s = svd.singularValues();
    for (Index d = 0; d < s.size(); ++d) {
      if (s[d] > 1e-7 * s[0]) continue;
      const VectorXd blind = free * svd.matrixV().col(d);
      for (Index i = 0; i < m; ++i)
        if (std::abs(blind[i]) > 0.3) fit.undetermined[static_cast<std::size_t>(i)] = true;
    }
  }
  // An orthonormal basis of what is perpendicular to all columns.
  static MatrixXd free_of(const MatrixXd& columns) {
    const Index m = columns.rows();
    if (columns.cols() == 0) return MatrixXd::Identity(m, m);
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
    const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(m, m);
    return Q.rightCols(m - qr.rank());
  }

  const std::vector<Unknown> start_;
  const std::vector<SmoothConstraint>& constraints_;
  const ResidualFunction& residuals_;
  const LeastSquaresOptions& options_;
  Coordinates coordinates_;
  VectorXd x_, low_, high_, r_;
  MatrixXd J_, bend_;  // bend_: S of learn_bend(), by `open_`; empty: none
  std::vector<Index> open_;
  std::vector<SmoothConstraint> moving_;
  std::vector<std::size_t> number_;
  std::vector<bool> binds_;  // of `moving_`, at the last step
  UnderConstraints result_;
};

}  // namespace

UnderConstraints minimise_under(const std::vector<Unknown>& start,
                                const std::vector<SmoothConstraint>& constraints,
                                const ResidualFunction& residuals,
                                const LeastSquaresOptions& options) {
  return Search(start, constraints, residuals, options).run();
}

}  // namespace hapsim
