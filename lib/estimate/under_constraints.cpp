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

constexpr double kBinds = 1e-7, kAnyLength = 1e300;

// A point, and what the residuals are there. By stepped coordinates J = Q R and r = Q q + what J
// does not see: steps and what is told of the end need R and q alone.
struct Point {
  VectorXd x, r, q;
  MatrixXd J, R;
  double sum = 0;  // |r|^2
};

class Search {
 public:
  Search(const std::vector<Unknown>& start, const std::vector<SmoothConstraint>& constraints,
         const ResidualFunction& residuals, const LeastSquaresOptions& options)
      : start_(start),
        constraints_(constraints),
        residuals_(residuals),
        options_(options),
        coordinates_(start_),
        low_(static_cast<Index>(start.size())),
        high_(low_.size()) {
    VectorXd& x = here_.x;
    x.resize(low_.size());
    for (Index i = 0; i < x.size(); ++i) {
      const auto u = static_cast<std::size_t>(i);
      x[i] = std::clamp(start[u].value, start[u].lower, start[u].upper);
      low_[i] = coordinates_.low(u);
      high_[i] = coordinates_.high(u);
      if (low_[i] < high_[i]) open_.push_back(i);
    }
    // What the unknowns that can move do not change is kept or not, whatever they are.
    for (std::size_t c = 0; c < constraints.size(); ++c) {
      const Taylor g = in_steps(constraints[c], coordinates_, x);
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
    if (!look(VectorXd(here_.x), here_)) {
      fit.message = "the start gives no finite forces";
      fit.x = here_.x;
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
  // What there is at x; false where there is nothing. J is asked for at once: nearly all steps are
  // good.
  bool look(const VectorXd& x, Point& at) {
    try {
      residuals_(x, at.r, &at.J);
    } catch (const Error& error) {  // a law without an equilibrium there
      if (error.code() != ExitCode::kNoConvergence) throw;
      return false;
    }
    at.x = x;
    at.sum = at.r.squaredNorm();
    if (!std::isfinite(at.sum)) return false;
    const Index m = x.size();
    for (Index i = 0; i < m; ++i)
      at.J.col(i) *= coordinates_.slope(static_cast<std::size_t>(i), x[i]);
    const Index rows = std::max(at.J.rows(), m);
    factored_.resize(rows, m + 1);
    factored_.bottomRows(rows - at.J.rows()).setZero();
    factored_.topLeftCorner(at.J.rows(), m) = at.J;
    factored_.col(m).head(at.r.size()) = at.r;
    const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> qr(factored_);  // in place
    at.R = factored_.topLeftCorner(m, m).triangularView<Eigen::Upper>();
    at.q = factored_.col(m).head(m);
    return true;
  }
  // No further than `box` away; none where there is none.
  std::optional<ConstrainedStep> step(double box, const MatrixXd& bend) {
    return constrained_step(moving_, coordinates_, open_, here_.x, here_.R(Eigen::all, open_),
                            here_.q, bend, {low_(open_), high_(open_), box}, binds_);
  }
  // Where much is left and the constraints hold it, steps without the residuals' own curvature
  // S = sum r_i d2r_i shrink by a constant factor only. S from the changes of J along the steps
  // (Dennis, Gay and Welsch, ACM Trans. Math. Softw. 7, 1981), whether they were taken or not, by
  // the symmetric change of rank one: S may bend down (Byrd, Khalfan and Schnabel, SIAM J. Optim.
  // 6, 1996). `moved`: to here_ from there_.
  void learn_bend(const VectorXd& moved) {
    const auto n = static_cast<Index>(open_.size());
    if (bend_.size() == 0) bend_ = MatrixXd::Zero(n, n);
    const VectorXd change = here_.R.transpose() * here_.q - there_.J.transpose() * here_.r;
    const VectorXd lacks = change(open_) - bend_ * moved;
    const double along = lacks.dot(moved);
    constexpr double kAcross = 1e-8;  // what says nothing of the curvature along the step
    if (std::abs(along) > kAcross * lacks.norm() * moved.norm())
      bend_ += lacks * lacks.transpose() / along;
  }
  static bool changes_nothing(const Point& at, Index i) {
    return at.R.col(i).norm() <= 1e-12 * std::sqrt(at.sum);
  }
  // Looks there, but not yet where an unknown at its bound makes others change nothing (a term
  // without stiffness has no relaxation time): from there they find no way. A tenth of the way is
  // left, a few times.
  bool look_there(double box, const MatrixXd& bend, ConstrainedStep& best) {
    if (!look(best.x, there_)) return false;
    const bool settles = std::any_of(open_.begin(), open_.end(), [&](Index i) {
      return changes_nothing(there_, i) && !changes_nothing(here_, i);
    });
    if (held_back_ == 0 || !settles) return true;
    --held_back_;
    constexpr double kLeft = 0.1;
    const VectorXd low = low_, high = high_, from = inner(here_.x), to = inner(best.x);
    for (std::size_t k = 0; k < open_.size(); ++k) {
      const auto at = static_cast<Index>(k);
      const Index i = open_[k];
      if (to[at] <= low[i] + kBinds && from[at] > low[i]) low_[i] += kLeft * (from[at] - low[i]);
      if (to[at] >= high[i] - kBinds && from[at] < high[i])
        high_[i] -= kLeft * (high[i] - from[at]);
    }
    const auto shorter = step(box, bend);
    low_ = low;
    high_ = high;
    if (shorter && keeps(shorter->x)) {
      best = *shorter;
      return look(best.x, there_);
    }
    return true;
  }

  // Where it is worse there, for the residuals bend along the step, a second step from there may
  // come down into the same valley (a watchdog: Chamberlain, Lemarechal, Pedersen and Powell,
  // Math. Program. Study 16, 1982). True where it does: there_ is its end then.
  bool comes_down(double length, ConstrainedStep& best) {
    std::vector<bool> binds = binds_;
    constexpr double kAside = 0.5;
    const auto second =
        constrained_step(moving_, coordinates_, open_, there_.x, there_.R(Eigen::all, open_),
                         there_.q, bend_, {low_(open_), high_(open_), kAside * length}, binds);
    if (!second || !keeps(second->x)) return false;
    if (!look(second->x, beyond_) || !(beyond_.sum < here_.sum)) return false;
    std::swap(there_, beyond_);
    best.x = second->x;
    best.fall = std::max(best.fall, here_.sum - there_.sum);
    binds_ = binds;
    return true;
  }

  // To a point that keeps the constraints: the best of the linearised residuals where there is one.
  bool begin() {
    if (keeps(here_.x)) return true;
    if (!open_.empty() && enough_freedom()) {
      auto best = step(kAnyLength, {});
      if (best && keeps(best->x) && look_there(kAnyLength, {}, *best)) {
        std::swap(here_, there_);
        return true;
      }
    }
    const std::optional<VectorXd> point = feasible_point(start_, constraints_);
    if (!point) {
      result_.fit.message = "no point keeps all constraints";
      return false;
    }
    if (!look(*point, here_)) result_.fit.message = "the start gives no finite forces";
    return result_.fit.message.empty();
  }
  bool enough_freedom() const {
    const auto equal = std::count_if(moving_.begin(), moving_.end(),
                                     [](const SmoothConstraint& c) { return c.equality; });
    return equal < static_cast<std::ptrdiff_t>(open_.size());
  }

  // A trust region (Nocedal and Wright, Numerical Optimization, 4.1) of the shape of a box.
  void descend() {
    LeastSquaresResult& fit = result_.fit;
    const auto converged = [&](const char* why = "converged") {
      fit.converged = true;
      fit.message = why;
    };
    constexpr double kTiny = 1e-5, kRounding = 1e-13;
    constexpr double kNear = 0.5;  // steps beyond which the curvature is another
    constexpr double kFar = 2;     // and linear residuals say nothing
    double box = kFar, before = 0;
    bool trusted = false;  // S has foretold the last fall
    if (open_.empty() || !enough_freedom())
      return converged("the constraints leave nothing to fit");
    while (fit.iterations < options_.max_iterations) {
      ++fit.iterations;
      const bool bent = bend_.size() > 0;
      auto best = step(box, bend_);
      if (!best) {
        if (box < 1e-6) break;
        bend_.resize(0, 0);
        box /= 4;
        continue;
      }
      VectorXd moved = inner(best->x) - inner(here_.x);
      double length = moved.cwiseAbs().maxCoeff();
      // Steps shrink by a constant factor where much is left: so far the end is still away.
      const double shrink = before > 0 ? std::min(0.9, length / before) : 0.5;
      if (length * std::max(1.0, shrink / (1 - shrink)) < options_.step_tolerance) {
        if (trusted || !bent) return converged();
        bend_.resize(0, 0);  // an end is one without S as well
        before = 0;
        continue;
      }
      const bool finite = look_there(box, bend_, *best);
      moved = inner(best->x) - inner(here_.x);
      length = moved.cwiseAbs().maxCoeff();
      bool in_two = false;
      if (finite && length < kNear && length > kTiny && there_.sum > here_.sum * (1 + kRounding)) {
        learn_bend(-moved);
        in_two = comes_down(length, *best);
      }
      if (in_two) {
        moved = inner(best->x) - inner(here_.x);
        length = moved.cwiseAbs().maxCoeff();
      }
      const double fall = here_.sum - there_.sum;
      // As far as rounding tells it is no better there; S may know.
      if (finite && length < kTiny && fall <= kRounding * here_.sum) {
        if (trusted && fall >= -kRounding * here_.sum) std::swap(here_, there_);
        return converged();
      }
      if (!finite || fall < -kRounding * here_.sum) {
        trusted = false;
        if (!(length < kNear) || !finite) bend_.resize(0, 0);
        box = length / 4;
        continue;
      }
      std::swap(here_, there_);
      trusted = bent && !in_two && std::abs(fall / best->fall - 1) < 0.3;
      if (length < kNear) learn_bend(moved);
      before = length;
      if (length > 0.9 * box && fall > 0.5 * best->fall) box = std::min(kFar, 2 * box);
      if (fall < 0.25 * best->fall) box = length / 2;
      if (options_.watch && !options_.watch(here_.sum)) {
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
    const VectorXd& x = here_.x;
    const Index m = x.size();
    fit.x = x;
    fit.sum_of_squares = here_.sum;
    const VectorXd pull = here_.R.transpose() * here_.q;
    std::vector<VectorXd> binding;
    std::vector<std::size_t> of;  // the constraint of a row; none of a bound
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Taylor g = in_steps(moving_[k], coordinates_, x);
      const double size = std::max(g.slope.norm(), 1e-300);
      result_.active[number_[k]] = moving_[k].equality || g.value <= kBinds * size;
      if (!result_.active[number_[k]]) continue;
      binding.emplace_back(g.slope / size);
      of.push_back(number_[k]);
    }
    constexpr std::size_t kBound = static_cast<std::size_t>(-1);
    for (Index i = 0; i < m; ++i) {
      const auto u = static_cast<std::size_t>(i);
      const double y = coordinates_.inner(u, x[i]);
      fit.at_bound[u] = y <= low_[i] + kBinds || y >= high_[i] - kBinds;
      if (!fit.at_bound[u]) continue;
      binding.emplace_back(VectorXd::Unit(m, i));
      of.push_back(kBound);
    }
    MatrixXd A(m, static_cast<Index>(binding.size()));
    for (Index b = 0; b < A.cols(); ++b) A.col(b) = binding[static_cast<std::size_t>(b)];
    const VectorXd factor =
        A.cols() == 0 ? VectorXd() : VectorXd(A.completeOrthogonalDecomposition().solve(2 * pull));
    result_.multiplier = VectorXd::Zero(static_cast<Index>(constraints_.size()));
    result_.worth = result_.multiplier;
    for (Index b = 0; b < A.cols(); ++b) {
      const std::size_t c = of[static_cast<std::size_t>(b)];
      if (c == kBound) continue;
      const Taylor g = in_steps(constraints_[c], coordinates_, x);
      result_.multiplier[static_cast<Index>(c)] = factor[b] / std::max(g.slope.norm(), 1e-300);
      MatrixXd others(m, A.cols() - 1);
      others << A.leftCols(b), A.rightCols(A.cols() - 1 - b);
      const MatrixXd can = free_of(others);
      const VectorXd own = can.transpose() * pull;
      result_.worth[static_cast<Index>(c)] = own.dot(normal_inverse(here_.R * can) * own);
    }
    VectorXd slope(m);
    for (Index i = 0; i < m; ++i) slope[i] = coordinates_.slope(static_cast<std::size_t>(i), x[i]);
    const auto active = std::count(result_.active.begin(), result_.active.end(), true);
    result_.settled = A.leftCols(active).transpose() * slope.cwiseInverse().asDiagonal();
    const MatrixXd free = free_of(A);
    result_.directions = slope.asDiagonal() * free;
    fit.covariance = MatrixXd::Zero(m, m);
    if (free.cols() == 0) return;
    const MatrixXd R = here_.R * free;
    fit.covariance = result_.directions * normal_inverse(R) * result_.directions.transpose();
    const Eigen::JacobiSVD<MatrixXd> svd(R, Eigen::ComputeThinU | Eigen::ComputeFullV);
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
  VectorXd low_, high_;
  Point here_, there_, beyond_;
  MatrixXd factored_, bend_;  // bend_: S of learn_bend(), by `open_`; empty: none
  std::vector<Index> open_;
  std::vector<SmoothConstraint> moving_;
  std::vector<std::size_t> number_;
  std::vector<bool> binds_;  // of `moving_`, at the last step
  int held_back_ = 3;        // more times
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
