#include "fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "effects/catalogue.h"
#include "estimate/identifiability.h"
#include "estimate/least_squares.h"
#include "estimate/multi_start.h"
#include "estimate/profile.h"
#include "fit/extend.h"
#include "fit/maxwell_terms.h"
#include "fit/move_limits.h"
#include "fit/press_offsets.h"

namespace hapsim {
namespace {

std::vector<Unknown> unknowns(const Model& model) {
  std::vector<Unknown> result;
  const Parameter* modulus = model.find("elastic", 0, "E");
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

void set_values(Model& model, const Eigen::VectorXd& x) {
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c)
    model.parameters[free[c]].value = x[static_cast<Eigen::Index>(c)];
}

// The range over which starts are spread, within the bounds: moduli from a thousandth to ten times
// the one that the gain of the forces asks for, times in seconds from half a sample's step to twice
// the longest press. Bounds alone leave 24 and 9 decades, nearly all of which say nothing of the
// data.
std::vector<Unknown> spread(const Model& model, std::vector<Unknown> unknowns,
                            const Dataset& dataset, const Selection& selection,
                            const BodyStiffness& body) {
  const double modulus = elastic_model(dataset, selection, body).find("elastic", 0, "E")->value;
  double longest = 0;
  for (const int e : selection)
    if (!dataset.episodes[e].view.t.empty())
      longest = std::max(longest, dataset.episodes[e].view.t.back());
  const double step = summarise(dataset, modulus).sample_step;
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    Unknown& u = unknowns[c];
    const auto within = [&u](double low, double high) {
      low = std::max(low, u.lower);
      high = std::min(high, u.upper);
      if (low < high) u.lower = low, u.upper = high;
    };
    const std::string& unit = model.parameters[free[c]].unit;
    if (unit == "Pa") within(1e-3 * modulus, 10 * modulus);
    if (unit == "s" && u.logarithmic && step > 0) within(step / 2, 2 * longest);
  }
  return unknowns;
}

double component_rms(const Eigen::VectorXd& r) {
  return r.size() == 0 ? 0 : std::sqrt(r.squaredNorm() / static_cast<double>(r.size()));
}

std::string label(const Parameter& p) {
  return p.effect + " " + p.name + (p.region > 0 ? " of region " + std::to_string(p.region) : "");
}

constexpr double kLeastReach = 0.02;  // a trust region so small has found what there is

// The parameters held at a bound are no part of it.
void tell_what_is_not_seen(FitResult& result, const Eigen::MatrixXd& J, double noise) {
  const std::vector<Unknown> all = unknowns(result.model);
  const std::vector<int> free = result.model.free_parameters();
  std::vector<Unknown> open;
  std::vector<std::string> names;
  std::vector<Eigen::Index> columns;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const std::string name = label(result.model.parameters[free[c]]);
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

void tell_intervals(FitResult& result, const ResidualFunction& residuals,
                    const LeastSquaresResult& solution, double variance) {
  const std::vector<Unknown> all = unknowns(result.model);
  const std::vector<int> free = result.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    if (solution.at_bound[c]) continue;
    const ProfileInterval p = profile_interval(all, residuals, solution, c, variance);
    result.intervals.push_back(fmt::format(
        "{}: 95 % from {:.4g}{} to {:.4g}{}{}", label(result.model.parameters[free[c]]), p.lower,
        p.open_below ? " (its bound)" : "", p.upper, p.open_above ? " (its bound)" : "",
        p.failed ? "; a fit on the way did not converge" : ""));
  }
}

}  // namespace

FitResult fit(const Model& start, const Dataset& dataset, const Selection& selection,
              BodyStiffness& body, const FitOptions& options) {
  FitResult result;
  result.model = start;
  const Eigen::VectorXd measured = measured_forces(dataset, selection);
  LeastSquaresResult solution;
  const MaterialSpec asked = material_of(start);
  const bool offsets = offset_effect(start) != nullptr;
  if (offsets) set_offsets(result.model, dataset, {}, {}, 0);
  // Without a solution the body is estimated, over the whole range.
  const bool linearised =
      is_linearised(asked, options.exact_regions) && (options.rounds > 0 || body.is_solved(asked));
  Model trial = result.model;
  const ResidualFunction residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                         Eigen::MatrixXd* J) {
    set_values(trial, x);
    Signal signal;
    try {
      signal = model_forces(trial, dataset, selection, body, J != nullptr);
    } catch (const Error& error) {
      // A law without an equilibrium there: a step that far is not taken.
      if (error.code() != ExitCode::kNoConvergence || J != nullptr) throw;
      r.setConstant(measured.size(), std::numeric_limits<double>::quiet_NaN());
      return;
    }
    r = (signal.f - measured) / options.noise;
    if (J != nullptr) *J = signal.df / options.noise;
    if (!offsets) return;
    take_out_press_means(dataset, selection, r);
    if (J != nullptr) take_out_press_means(dataset, selection, *J);
  };
  FitProgress progress{options.skip, options.starts};
  const auto go_on = [&](double sum) {
    const double now = options.noise * std::sqrt(sum / static_cast<double>(measured.size()));
    if (!(progress.rmse <= now)) progress.rmse = now;
    return !options.watch || options.watch(progress);
  };
  LeastSquaresOptions search;
  if (options.watch) search.watch = go_on;
  result.starts_done = options.starts;
  bool from_many = options.starts > 1;  // once: later rounds improve on the valley found
  const auto minimise_within = [&](double reach) {
    trial = result.model;
    if (from_many) {
      Random random(options.seed);
      const std::vector<Unknown> open = unknowns(result.model);
      auto starts = latin_hypercube_starts(spread(result.model, open, dataset, selection, body),
                                           options.starts, random);
      for (std::vector<Unknown>& one : starts)  // spread so, but bounded as ever
        for (std::size_t i = 0; i < one.size(); ++i) {
          one[i].lower = open[i].lower;
          one[i].upper = open[i].upper;
        }
      // The given start is the first in any case.
      const int skip = std::clamp(options.skip - 1, 0, options.starts - 1);
      starts.erase(starts.begin() + 1, starts.begin() + 1 + skip);
      MultiStartResult many =
          minimise_from_many(starts, residuals, search, 0.1, [&](int number, double sum) {
            progress.start = number == 0 ? 0 : number + skip;
            return std::isinf(sum) || go_on(sum);
          });
      result.stopped = many.best.stopped;
      if (result.stopped) result.starts_done = many.starts == 0 ? 0 : many.starts + skip;
      solution = std::move(many.best);
      set_values(result.model, solution.x);
      from_many = false;
      if (result.stopped) return;
    }
    std::vector<Unknown> open = unknowns(result.model);
    if (linearised) open = within_reach(std::move(open), result.model, reach);
    if (options.robust != RobustLoss::kNone) {
      RobustResult robust = minimise_robustly(open, residuals, options.robust, search);
      solution = std::move(robust.fit);
      result.discounted = robust.discounted;
    } else {
      solution = minimise(open, residuals, search);
    }
    set_values(result.model, solution.x);
    result.stopped = solution.stopped;
    if (result.stopped) return;
    if (options.robust != RobustLoss::kNone) return;
    if (sort_terms(result.model)) {
      open = unknowns(result.model);
      if (linearised) open = within_reach(std::move(open), result.model, reach);
      solution = minimise(open, residuals, search);
      set_values(result.model, solution.x);
      result.stopped = solution.stopped;
    }
    if (!options.keep_apart || result.stopped) return;
    keep_terms_apart(result.model, open, residuals, solution);
    set_values(result.model, solution.x);
  };
  if (!linearised || options.rounds == 0) {
    minimise_within(1);
  } else {
    // The finite elements are solved again about each fit; a fit that their solution does not
    // confirm is taken back and tried again closer by (a trust region).
    // After each solution, what needs none is fitted anew: a modulus too large or too small for a
    // new body must not hide that the body has become better.
    const auto true_sum = [&] {
      const MaterialSpec material = material_of(result.model);
      body.solve(material);
      trial = result.model;
      const std::vector<Unknown> open = unknowns(result.model);
      if (material.modulus.size() == 1) {
        const LeastSquaresResult rest = minimise(within_reach(open, result.model, 0), residuals);
        set_values(result.model, rest.x);
        return rest.sum_of_squares;
      }
      Eigen::VectorXd x(static_cast<Eigen::Index>(open.size())), r;
      for (std::size_t c = 0; c < open.size(); ++c) x[static_cast<Eigen::Index>(c)] = open[c].value;
      residuals(x, r, nullptr);
      return r.squaredNorm();
    };
    double sum = true_sum(), reach = 1;
    bool settled = false;
    for (int round = 0; round < options.rounds && !settled && !result.stopped; ++round) {
      const Model before = result.model;
      minimise_within(reach);
      if (result.stopped) break;
      const double promised = sum - solution.sum_of_squares;
      const double now = true_sum();
      const double least = options.settled * sum;
      settled = promised < least || (now <= sum && sum - now < least) || reach < kLeastReach;
      if (now <= sum) {
        sum = now;
        result.stopped = !go_on(sum);
        continue;
      }
      result.model = before;
      body.solve(material_of(before));
      reach /= 4;
    }
    // Bounds and covariance without the limits of the steps.
    trial = result.model;
    LeastSquaresOptions once;
    once.max_iterations = 1;
    const bool converged = solution.converged && settled;
    const std::string message = solution.message;
    solution = minimise(unknowns(result.model), residuals, once);
    solution.converged = converged || options.rounds < kFullRounds;
    solution.message = converged ? message : "the body does not settle";
    solution.sum_of_squares = sum;
  }

  Signal signal = model_forces(result.model, dataset, selection, body, true);
  Eigen::VectorXd residual = measured - signal.f;
  if (offsets) {
    const Eigen::MatrixXd means = press_means(dataset, selection, residual);
    take_out_press_means(dataset, selection, residual);
    set_offsets(result.model, dataset, selection, means,
                std::max(options.noise, component_rms(residual)));
    take_out_press_means(dataset, selection, signal.df);
  }
  result.rmse = component_rms(residual);
  result.residuals = residual.size();
  result.converged = solution.converged && !result.stopped;
  result.message = result.stopped ? "interrupted" : solution.message;
  const std::vector<int> free = result.model.free_parameters();
  const double freedom =
      std::max(1.0, static_cast<double>(result.residuals) - static_cast<double>(free.size()));
  const double variance = std::max(1.0, solution.sum_of_squares / freedom);
  // The robust covariance has the misfit in it.
  Eigen::MatrixXd covariance =
      options.robust == RobustLoss::kNone ? variance * solution.covariance : solution.covariance;
  if (options.floor > 0) {
    // A gain error of each position, carried through to the parameters (sandwich).
    for (const GainBlock& block : gain_directions(dataset, selection, signal.f)) {
      const Eigen::MatrixXd rows = signal.df(block.rows, Eigen::all);
      const Eigen::MatrixXd through = solution.covariance * (rows.transpose() * block.Z) *
                                      (options.floor / (options.noise * options.noise));
      covariance += through * through.transpose();
    }
  }
  for (std::size_t c = 0; c < free.size(); ++c) {
    Parameter& p = result.model.parameters[free[c]];
    const auto k = static_cast<Eigen::Index>(c);
    const bool unseen = solution.undetermined[c];
    p.std_error = solution.at_bound[c] || unseen ? std::numeric_limits<double>::quiet_NaN()
                                                 : std::sqrt(std::max(0.0, covariance(k, k)));
    if (solution.at_bound[c]) result.at_bound.push_back(label(p));
    if (unseen) result.undetermined.push_back(label(p));
  }
  tell_what_is_not_seen(result, signal.df / options.noise, std::sqrt(variance));
  if (options.profile && result.converged) tell_intervals(result, residuals, solution, variance);
  return result;
}

double rmse(const Model& model, const Dataset& dataset, const Selection& selection,
            const BodyStiffness& body) {
  return component_rms(measured_forces(dataset, selection) -
                       model_forces(model, dataset, selection, body, false).f);
}

Folds make_folds(const Dataset& dataset, int count) {
  Folds folds;
  const bool by_position = dataset.positions.size() > 1;
  const std::size_t groups = by_position ? dataset.positions.size() : dataset.episodes.size();
  if (groups < 2 || count < 2) return folds;
  folds.by = by_position ? "positions" : "presses";
  folds.held_out.resize(std::min<std::size_t>(groups, static_cast<std::size_t>(count)));
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e) {
    const std::size_t group =
        by_position ? static_cast<std::size_t>(dataset.episodes[e].position) : e;
    folds.held_out[group % folds.held_out.size()].push_back(static_cast<int>(e));
  }
  return folds;
}

Folds make_press_folds(const Dataset& dataset, int count) {
  Folds folds{std::vector<Selection>(static_cast<std::size_t>(count)), "presses"};
  std::vector<std::size_t> presses(dataset.positions.size(), 0);
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e) {
    const auto p = static_cast<std::size_t>(dataset.episodes[e].position);
    folds.held_out[(p + presses[p]++) % folds.held_out.size()].push_back(static_cast<int>(e));
  }
  std::erase_if(folds.held_out, [](const Selection& part) { return part.empty(); });
  if (folds.held_out.size() < 2) folds.held_out.clear();
  return folds;
}

HeldOut held_out_error(const ModelBuilder& builder, const Dataset& dataset, const Folds& folds,
                       BodyStiffness& body, const FitOptions& options) {
  HeldOut result;
  FitOptions about = options;
  about.rounds = 0;
  double squares = 0, components = 0;
  for (const Selection& held_out : folds.held_out) {
    Selection training;
    for (const int e : all_episodes(dataset))
      if (std::find(held_out.begin(), held_out.end(), e) == held_out.end()) training.push_back(e);
    const FitResult fitted = fit_best(builder(training), dataset, training, body, about);
    Eigen::VectorXd r = measured_forces(dataset, held_out) -
                        model_forces(fitted.model, dataset, held_out, body, false).f;
    if (offset_effect(fitted.model) != nullptr) take_out_cross_means(dataset, held_out, r);
    result.squares.push_back(r.squaredNorm());
    result.components.push_back(static_cast<double>(r.size()));
    squares += result.squares.back();
    components += result.components.back();
  }
  result.rmse =
      components > 0 ? std::sqrt(squares / components) : std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace hapsim
