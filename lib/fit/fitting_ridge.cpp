#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "fit/fit_uncertainty.h"
#include "fit/fitting.h"
#include "fit/move_limits.h"
#include "fit/ridge.h"

namespace hapsim {
namespace {

constexpr double kTold = 0.1;      // standard error of a logarithm that a parabola tells well
constexpr double kFarthest = 0.7;  // a step's logarithm: what a linearised body follows
constexpr double kNearest = 0.05;

// (J'J)^-1 with the columns of parameters at their bounds, in their units.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& J) {
  Eigen::VectorXd scale = J.colwise().norm().transpose();
  for (double& s : scale) s = s > 0 ? 1 / s : 0;
  const Eigen::MatrixXd unit = J * scale.asDiagonal();
  return scale.asDiagonal() *
         (unit.transpose() * unit).completeOrthogonalDecomposition().pseudoInverse() *
         scale.asDiagonal();
}

}  // namespace

// Of each effect the size that is known least, where the parabola does not tell enough.
std::vector<Eigen::Index> Fitting::ridges(const Eigen::MatrixXd& covariance) const {
  std::vector<Eigen::Index> chosen;
  const std::vector<int> free = result_.model.free_parameters();
  std::string effect;
  double worst = 0;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = result_.model.parameters[static_cast<std::size_t>(free[c])];
    if (!may_have_ridge(p) || solution_.undetermined[c]) continue;
    const auto k = static_cast<Eigen::Index>(c);
    const double error = std::sqrt(std::max(0.0, covariance(k, k))) / p.value;
    if (!(error > kTold) && !solution_.at_bound[c]) continue;
    if (p.effect != effect) {
      chosen.push_back(k);
      worst = error;
    } else if (error > worst) {
      chosen.back() = k;
      worst = error;
    }
    effect = p.effect;
  }
  return chosen;
}

double Fitting::fit_beside(Eigen::Index which, double value, double settled) {
  constexpr int kRounds = 3;
  double best = std::numeric_limits<double>::infinity();
  result_.model
      .parameters[static_cast<std::size_t>(
          result_.model.free_parameters()[static_cast<std::size_t>(which)])]
      .value = value;
  Model best_model = result_.model;  // where no law has an equilibrium on the way
  Linearisation best_about = result_.about;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Unknown> open = open_within(1);
    Unknown& held = open[static_cast<std::size_t>(which)];
    held.lower = held.upper = held.value = value;
    const LeastSquaresResult others = minimise(open, residuals_of(result_.model));
    set_unknowns(result_.model, others.x);
    const double sum = solved_sum();
    const bool done = std::abs(sum - others.sum_of_squares) < settled || sum > best - settled;
    if (sum < best) {
      best = sum;
      best_model = result_.model;
      best_about = result_.about;
    }
    if (done) break;
  }
  result_.model = std::move(best_model);
  result_.about = std::move(best_about);
  return best;
}

Ridge Fitting::walk(Eigen::Index which, double error, double threshold) {
  constexpr int kMost = 16;
  constexpr double kSettled = 0.03;  // of the threshold: 1.5 % of the way to it
  const Model model = result_.model;
  const Linearisation about = result_.about;
  const double sum = solution_.sum_of_squares;
  const Unknown own = unknowns(model)[static_cast<std::size_t>(which)];
  const auto values = [&] { return values_of(unknowns(result_.model)); };
  Ridge ridge;
  ridge.which = which;
  ridge.along.push_back(values());
  for (const int side : {-1, 1}) {
    result_.model = model;
    result_.about = about;
    double& end = side < 0 ? ridge.low : ridge.high;
    bool& open = side < 0 ? ridge.open_low : ridge.open_high;
    double at = std::log(own.value), root = 0;
    double step = std::clamp(error, kNearest, kFarthest);
    const double bound = std::log(side < 0 ? own.lower : own.upper);
    Eigen::VectorXd before = ridge.along.front();
    open = true;
    end = std::exp(bound);
    for (int k = 0; k < kMost; ++k) {
      const double next = side < 0 ? std::max(bound, at - step) : std::min(bound, at + step);
      if (std::abs(next - at) < 1e-9) break;
      const double rise = fit_beside(which, std::exp(next), kSettled * threshold) - sum;
      result_.stopped = result_.stopped || !go_on(sum);
      if (result_.stopped) return ridge;
      const double now = std::copysign(std::sqrt(std::abs(rise) / threshold), rise);
      const Eigen::VectorXd x = values();
      if (now >= 1) {  // the root of the rise is nearly straight
        const double share = std::clamp((1 - root) / (now - root), 0.0, 1.0);
        end = std::exp(at + share * (next - at));
        open = false;
        ridge.along.push_back(before + share * (x - before));
        break;
      }
      ridge.along.push_back(x);
      if (now < lowest_) {
        lowest_ = now;
        lowest_at_ = result_;
      }
      // Half of the way to the threshold, or just past it.
      const double slope = (now - root) / std::abs(next - at);
      const double wanted = now < 0.55 ? now + 0.5 : 1.05;
      step = slope > 0 ? std::clamp((wanted - now) / slope, kNearest, kFarthest) : kFarthest;
      at = next;
      root = now;
      before = x;
    }
  }
  result_.model = model;
  result_.about = about;
  return ridge;
}

Fitting::Covariance Fitting::beyond_bounds(const Signal& signal, const FitOptions& errors,
                                           double variance) const {
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
  residuals_of(result_.model)(values_of(unknowns(result_.model)), r, &J);
  const Eigen::MatrixXd bread = inverse_of(J);
  return {bread, error_covariance(bread, signal, experiment_, selection_, errors, variance,
                                  by_gain_of_all(signal, bread))};
}

bool Fitting::tells_profiles() const {
  return options_.ridges && converged() && constraints_.empty() &&
         options_.robust == RobustLoss::kNone;
}

bool Fitting::tell_ridges(const Signal& signal, const FitOptions& errors, double variance) {
  if (!tells_profiles() || !is_linearised_ || options_.rounds < kFullRounds) return true;
  const auto [bread, covariance] = beyond_bounds(signal, errors, variance);
  const TorqueRows torques = torques_;
  const MarkerRows marked = marked_;
  const Eigen::VectorXd x = values_of(unknowns(result_.model));
  bool stays = true;
  for (const Eigen::Index which : ridges(covariance)) {
    const double own = covariance(which, which), alone = bread(which, which);
    if (!(own > 0) || !(alone > 0)) continue;
    lowest_ = -0.2;  // a rise below is a better fit elsewhere
    const Ridge ridge = walk(which, std::sqrt(own) / x[which], kRise95 * own / alone);
    if (result_.stopped) break;
    if (lowest_ < -0.2 && !walked_on_) {
      result_ = lowest_at_;
      stays = false;
      break;
    }
    set_ridge_errors(result_, ridge, bread, covariance);
  }
  torques_ = torques;
  marked_ = marked;
  return stays;
}

}  // namespace hapsim
