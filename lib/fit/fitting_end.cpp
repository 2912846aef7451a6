#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "fit/constraints.h"
#include "fit/fit_uncertainty.h"
#include "fit/fitting.h"
#include "fit/press_offsets.h"

namespace hapsim {

Fit Fitting::end() {
  Signal signal = model_forces(result_, experiment_, selection_, true);
  Eigen::VectorXd residual = measured_ - signal.f;
  if (has_offsets_) {
    const Eigen::MatrixXd means = press_means(dataset_, selection_, residual);
    take_out_press_means(dataset_, selection_, residual);
    set_offsets(result_.model, dataset_, selection_, means,
                std::max(options_.noise, force_error(dataset_, residual).pooled));
    take_out_press_means(dataset_, selection_, signal.df);
  }
  result_.error = force_error(dataset_, residual);
  result_.residuals = residual.size();
  result_.converged = converged();
  result_.message = result_.stopped ? "interrupted" : solution_.message;
  const auto free = static_cast<double>(constraints_.empty()
                                            ? result_.model.free_parameters().size()
                                            : static_cast<std::size_t>(under_.directions.cols()));
  const double freedom = std::max(1.0, static_cast<double>(rows()) - free);
  const double variance = std::max(1.0, solution_.sum_of_squares / freedom);
  FitOptions errors = options_;
  if (force_weights_) errors.floor = 0;  // of each position: it is in the weights
  set_standard_errors(
      result_, solution_,
      error_covariance(solution_.covariance, signal, experiment_, selection_, errors, variance,
                       by_gain_of_all(signal, solution_.covariance)));
  if (!tell_ridges(signal, errors, variance)) {  // a better fit was met on the way: from there
    walked_on_ = true;
    result_.at_bound.clear();
    result_.undetermined.clear();
    result_.blind.clear();
    minimise_in_rounds();
    return end();
  }
  tell_bounds(signal, errors, variance);
  widen_by_groups(signal, residual);
  if (result_.stopped) result_.converged = false, result_.message = "interrupted";
  Eigen::VectorXd whitened = residual / options_.noise;
  Eigen::MatrixXd J = signal.df / options_.noise;
  torques_.append(result_.model, result_.about, signal, whitened, &J);
  result_.torque = torques_.error(result_.model, result_.about);
  marked_.append(result_.model, whitened, &J);
  result_.marker = marked_.error(result_.model);
  if (constraints_.empty())
    tell_what_is_not_seen(result_, J, std::sqrt(variance));
  else
    tell_constraints(J, variance);
  if (options_.profile && result_.converged)
    tell_intervals(result_, residuals_of(result_.model), solution_, variance);
  return std::move(result_);
}

Eigen::VectorXd Fitting::by_gain_of_all(const Signal& signal, const Eigen::MatrixXd& bread) const {
  std::set<int> positions;
  for (const int e : selection_) positions.insert(dataset_.episodes[e].position);
  if (positions.size() < 2 || !(options_.floor > 0)) return Eigen::VectorXd::Zero(signal.df.cols());
  Eigen::MatrixXd J = signal.df;
  Eigen::VectorXd f = signal.f;
  whiten(J);
  whiten(f);
  return options_.floor * (bread * (J.transpose() * f));
}

void Fitting::tell_constraints(const Eigen::MatrixXd& J, double variance) {
  const double count = static_cast<double>(rows());
  const double told = options_.noise * std::sqrt(3.0 / result_.error.axes / count);
  const double sum = solution_.sum_of_squares;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    KeptConstraint kept;
    kept.active = under_.active[c];
    const double worth = std::min(sum, under_.worth[static_cast<Eigen::Index>(c)]);
    if (kept.active) kept.cost = told * (std::sqrt(sum) - std::sqrt(sum - worth));
    if (kept.active) kept.doubt = std::sqrt(worth / variance);
    result_.constraints.push_back(kept);
  }
  const std::vector<int> free = result_.model.free_parameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Parameter& p = result_.model.parameters[static_cast<std::size_t>(free[i])];
    constexpr double kNothing = 1e-9;  // of the unknown's own steps
    const double size = std::max(std::abs(p.value), 1e-300);
    if (solution_.at_bound[i] || under_.directions.row(row).norm() > kNothing * size) continue;
    p.std_error = std::numeric_limits<double>::quiet_NaN();
    result_.held.push_back(parameter_name(p));
  }
  // What a constraint settles is seen as well as any reading could.
  constexpr double kSettled = 1e6;
  Eigen::MatrixXd seen(J.rows() + under_.settled.rows(), J.cols());
  seen << J, kSettled * under_.settled;
  tell_what_is_not_seen(result_, seen, std::sqrt(variance));
}

}  // namespace hapsim
