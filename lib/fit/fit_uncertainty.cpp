#include "fit/fit_uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/catalogue.h"
#include "estimate/identifiability.h"
#include "estimate/profile.h"
#include "model/body_parameters.h"

namespace hapsim {

std::string parameter_label(const Parameter& p) {
  return p.effect + " " + p.name + (p.region > 0 ? " of region " + std::to_string(p.region) : "");
}

std::vector<Unknown> unknowns(const Model& model) {
  std::vector<Unknown> result;
  const Parameter* modulus = modulus_of(model);
  const double typical = modulus != nullptr ? 0.1 * std::abs(modulus->value) : 1.0;
  for (const int i : model.free_parameters()) {
    const Parameter& p = model.parameters[i];
    const ParameterCard& card = *parameter_card(require_effect(p.effect), p.name);
    // A modulus sets its own scale, unless it is next to nothing beside the body's (steps from
    // there would be as small); other parameters have their card's.
    const double scale =
        card.unit == "Pa" ? std::max({std::abs(p.value), typical, 1.0}) : card.scale;
    const double lower =
        card.logarithmic ? std::max(p.lower, 1e-12 * std::max(p.value, 1e-300)) : p.lower;
    result.push_back({p.value, lower, p.upper, scale, card.logarithmic, card.log_limit});
  }
  return result;
}

Eigen::VectorXd values_of(const std::vector<Unknown>& unknowns) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t c = 0; c < unknowns.size(); ++c)
    x[static_cast<Eigen::Index>(c)] = unknowns[c].value;
  return x;
}

void set_unknowns(Model& model, const Eigen::VectorXd& x) {
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c)
    model.parameters[free[c]].value = x[static_cast<Eigen::Index>(c)];
}

Eigen::MatrixXd error_covariance(const Eigen::MatrixXd& bread, const Signal& signal,
                                 const Experiment& experiment, const Selection& selection,
                                 const FitOptions& options, double variance,
                                 const Eigen::VectorXd& shared) {
  // The robust covariance has the misfit in it.
  Eigen::MatrixXd covariance = options.robust == RobustLoss::kNone ? variance * bread : bread;
  if (options.floor > 0) {
    // What each position may err by, carried through to the parameters (sandwich).
    const std::vector<GainBlock> blocks = gain_directions(experiment.dataset, selection, signal.f);
    for (const GainBlock& block : blocks) {
      const Eigen::MatrixXd rows = signal.df(block.rows, Eigen::all);
      const double floor =
          experiment.dataset.floor_at(static_cast<std::size_t>(block.position), options.floor);
      const Eigen::MatrixXd through =
          bread * (rows.transpose() * block.deviations(floor)) / (options.noise * options.noise);
      covariance += through * through.transpose();
    }
  }
  return covariance + shared * shared.transpose();
}

void set_standard_errors(Fit& result, const LeastSquaresResult& solution,
                         const Eigen::MatrixXd& covariance) {
  const std::vector<int> free = result.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    Parameter& p = result.model.parameters[free[c]];
    const auto k = static_cast<Eigen::Index>(c);
    const bool unseen = solution.undetermined[c];
    p.std_error = solution.at_bound[c] || unseen ? std::numeric_limits<double>::quiet_NaN()
                                                 : std::sqrt(std::max(0.0, covariance(k, k)));
    if (solution.at_bound[c]) result.at_bound.push_back(parameter_label(p));
    if (unseen) result.undetermined.push_back(parameter_label(p));
  }
}

// The parameters held at a bound are no part of it.
void tell_what_is_not_seen(Fit& result, const Eigen::MatrixXd& J, double noise) {
  const std::vector<Unknown> all = unknowns(result.model);
  const std::vector<int> free = result.model.free_parameters();
  std::vector<Unknown> open;
  std::vector<std::string> names;
  std::vector<Eigen::Index> columns;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const std::string name = parameter_label(result.model.parameters[free[c]]);
    if (std::find(result.at_bound.begin(), result.at_bound.end(), name) != result.at_bound.end())
      continue;
    open.push_back(all[c]);
    names.push_back(name);
    columns.push_back(static_cast<Eigen::Index>(c));
  }
  if (open.size() < 2) return;  // a single unseen parameter is called undetermined already
  for (const BlindDirection& d : blind_directions(open, names, J(Eigen::all, columns), 1, noise))
    if (d.sentence.find(" and ") != std::string::npos) result.blind.push_back(d.sentence);
}

void tell_intervals(Fit& result, const ResidualFunction& residuals,
                    const LeastSquaresResult& solution, double variance) {
  const std::vector<Unknown> all = unknowns(result.model);
  const std::vector<int> free = result.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    if (solution.at_bound[c]) continue;
    const ProfileInterval p = profile_interval(all, residuals, solution, c, variance);
    result.intervals.push_back(fmt::format(
        "{}: 95 % from {:.4g}{} to {:.4g}{}{}", parameter_label(result.model.parameters[free[c]]),
        p.lower, p.open_below ? " (its bound)" : "", p.upper, p.open_above ? " (its bound)" : "",
        p.failed ? "; a fit on the way did not converge" : ""));
  }
}

}  // namespace hapsim
