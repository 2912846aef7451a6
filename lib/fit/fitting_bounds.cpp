#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/fit_uncertainty.h"
#include "fit/fitting.h"
#include "fit/ridge.h"
#include "model/interval.h"

namespace hapsim {
namespace {

// The way from a value to another; in logarithms where it is stepped so.
struct Way {
  double from = 0, to = 0;
  bool logarithmic = false;
  Way(const Unknown& u, double value) : logarithmic(u.logarithmic) {
    from = logarithmic ? std::log(u.value) : u.value;
    to = logarithmic ? std::log(value) : value;
  }
  double at(double share) const {
    const double v = from + share * (to - from);
    return logarithmic ? std::exp(v) : v;
  }
};

// Of a change, as intervals are told (model/interval.h).
double size(const Parameter& p, double change) {
  return is_logarithmic(p) && p.value + change > 0
             ? p.value * std::abs(std::log1p(change / p.value))
             : std::abs(change);
}

constexpr double kFar = 8;  // standard errors: what is farther a parabola tells well

// How far a walk goes at most.
double end_of_walk(const Unknown& u, double error, int side) {
  const double bound = side < 0 ? u.lower : u.upper;
  if (!(error > 0)) return bound;
  const double far = u.logarithmic ? u.value * std::exp(side * kFar * error / u.value)
                                   : u.value + side * kFar * error;
  return side < 0 ? std::max(bound, far) : std::min(bound, far);
}

// Of a parameter with a range that is hardly known within it.
bool may_be_at_a_bound(const Unknown& u, double error) {
  const double half = kHalf95 * error;
  return !u.logarithmic && kFar * error > std::max(u.value - u.lower, u.upper - u.value) &&
         (u.value - half < u.lower || u.value + half > u.upper);
}

}  // namespace

// How far the others move, and where a parameter is, on its way to a value: where the sum of
// squares has risen by `most`, or there.
Fitting::Moved Fitting::move_to(Eigen::Index which, double value, double most) {
  const std::vector<Unknown> all = unknowns(result_.model);
  const Eigen::VectorXd start = values_of(all);
  const Way way(all[static_cast<std::size_t>(which)], value);
  const double sum = solution_.sum_of_squares;
  const Model model = result_.model;
  const Linearisation about = result_.about;
  Eigen::VectorXd before = Eigen::VectorXd::Zero(start.size());
  Moved moved{before, way.at(0)};
  double share = 0, risen = 0;
  for (const double next : {0.02, 0.06, 0.2, 0.5, 1.0}) {
    if (way.to == way.from) break;
    const double rise = fit_beside(which, way.at(next), 0.03 * most) - sum;
    result_.stopped = result_.stopped || !go_on(sum);
    if (result_.stopped) break;
    Eigen::VectorXd x = values_of(unknowns(result_.model)) - start;
    const double part = rise > most ? (most - risen) / (rise - risen) : 1;
    x = before + part * (x - before);
    moved.by = (x.array().abs() > moved.by.array().abs()).select(x, moved.by);
    moved.until = way.at(share + part * (next - share));
    if (rise > most) break;
    before = x;
    share = next;
    risen = rise;
  }
  result_.model = model;
  result_.about = about;
  return moved;
}

// A bound tells no more of the others than that the truth lies within it, and near it a parabola
// tells too little: of the stiffness by Poisson's ratio the derivative is 0 at 0. The parameter is
// moved each way, the others fitted beside it, to the end of its interval of 95 % (the profile of
// its likelihood: Venzon and Moolgavkar, Appl. Statist. 37, 1988), or to a bound: what they moved
// by on the way, with what they are uncertain by beside it, is half of an interval of theirs.
void Fitting::tell_bounds(const Signal& signal, const FitOptions& errors, double variance) {
  if (!tells_profiles() || is_linearised_) return;  // where it is, each step solves for all places
  const std::vector<int> free = result_.model.free_parameters();
  const std::vector<Unknown> all = unknowns(result_.model);
  const auto parameter = [&](std::size_t c) -> Parameter& {
    return result_.model.parameters[static_cast<std::size_t>(free[c])];
  };
  std::vector<std::size_t> close;
  for (std::size_t c = 0; c < free.size(); ++c)
    if (solution_.at_bound[c] || may_be_at_a_bound(all[c], parameter(c).std_error))
      close.push_back(c);
  if (close.empty()) return;
  const Covariance covariance = beyond_bounds(signal, errors, variance);
  // The rise of the sum of squares there; gains of places are no noise (as of a ridge).
  double most = variance;
  for (Eigen::Index c = 0; c < covariance.bread.cols(); ++c)
    if (covariance.bread(c, c) > 0)
      most = std::max(most, covariance.whole(c, c) / covariance.bread(c, c));
  most *= kRise95;
  const TorqueRows torques = torques_;
  const MarkerRows marked = marked_;
  for (const std::size_t c : close) {
    const auto which = static_cast<Eigen::Index>(c);
    const double error = std::sqrt(std::max(0.0, covariance.whole(which, which)));
    const Moved down = move_to(which, end_of_walk(all[c], error, -1), most),
                up = move_to(which, end_of_walk(all[c], error, 1), most);
    if (result_.stopped) break;
    for (std::size_t other = 0; other < free.size(); ++other) {
      const auto k = static_cast<Eigen::Index>(other);
      if (other == c) continue;
      double beside = parameter(other).std_error * parameter(other).std_error;
      if (!solution_.at_bound[c])
        beside = covariance.whole(k, k) - covariance.whole(k, which) * covariance.whole(k, which) /
                                              covariance.whole(which, which);
      const double half =
          std::max(size(parameter(other), down.by[k]), size(parameter(other), up.by[k])) / kHalf95;
      const double whole = std::sqrt(std::max(0.0, beside) + half * half);
      if (whole > parameter(other).std_error) parameter(other).std_error = whole;
    }
    if (!solution_.at_bound[c]) continue;
    result_.blind.push_back(fmt::format(
        "{}: from {:.3g} to {:.3g} all fit alike, and the errors of the others count that",
        parameter_label(parameter(c)), down.until, up.until));
  }
  torques_ = torques;
  marked_ = marked;
}

}  // namespace hapsim
