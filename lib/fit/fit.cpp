#include "fit/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "effects/catalogue.h"
#include "estimate/feasible.h"
#include "estimate/least_squares.h"
#include "estimate/multi_start.h"
#include "estimate/under_constraints.h"
#include "fit/constraints.h"
#include "fit/extend.h"
#include "fit/fit_uncertainty.h"
#include "fit/learned_field.h"
#include "fit/marker_rows.h"
#include "fit/maxwell_terms.h"
#include "fit/move_limits.h"
#include "fit/press_offsets.h"
#include "fit/torque_rows.h"
#include "model/body_parameters.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

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
                            const Experiment& experiment, const Selection& selection) {
  const Dataset& dataset = experiment.dataset;
  const double modulus = modulus_of(elastic_model(experiment, selection))->value;
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

constexpr int kFieldRounds = 4;  // of a field and what is fitted beside it
constexpr double kFieldSettled = 1e-3;
constexpr double kLeastReach = 0.02;  // a trust region so small has found what there is

// One fit under way: the model as far as it has come, and the bodies about its material.
class Fitting {
 public:
  Fitting(const Model& start, const Experiment& experiment, const Selection& selection,
          const FitOptions& options, const Linearisation& known,
          const std::vector<SmoothConstraint>& constraints = {})
      : experiment_(experiment),
        dataset_(experiment.dataset),
        selection_(selection),
        options_(options),
        constraints_(constraints),
        measured_(measured_forces(dataset_, selection)),
        has_offsets_(offset_effect(start) != nullptr),
        learns_field_(learns_field(start)),
        progress_{options.skip, options.starts},
        from_many_(options.starts > 1) {
    result_.model = start;
    result_.starts_done = options.starts;
    if (has_offsets_) set_offsets(result_.model, dataset_, {}, {}, 0);
    if (options.torques) torques_ = TorqueRows(start, experiment, selection, options, has_offsets_);
    marked_ = MarkerRows(start, experiment, selection, options);
    const MaterialSpec asked = material_of(start);
    result_.about = experiment.places.estimate(asked, known);
    // What forces, torques and points tell of one thing is weighed by what each is worth. By forces
    // of a model: relative errors of measured ones would draw the fit to small forces, which their
    // noise makes look better.
    if ((!torques_.empty() || !marked_.empty()) && options.floor > 0)
      force_weights_.emplace(dataset_, selection,
                             model_forces(start, experiment, result_.about, selection, false).f,
                             options.noise, options.floor);
    // What is not solved for is estimated, over the whole range.
    is_linearised_ = is_linearised(asked, options.exact_regions) &&
                     (options.rounds > 0 || result_.about.is_solved_for(asked));
    if (options.watch) search_.watch = [this](double sum) { return go_on(sum); };
    // Steps of a linearised body have a reach, within which the constraints are to have a point.
    if (constraints_.empty() || !is_linearised_) return;
    if (const auto point = feasible_point(unknowns(result_.model), constraints_))
      set_values(result_.model, *point);
  }

  void search() {
    if (learns_field_)
      minimise_with_field();
    else
      minimise_all();
  }
  // What is told of where the search has ended.
  Fit end() {
    finish();
    return std::move(result_);
  }

  // Where it has ended, before that.
  const Model& model() const { return result_.model; }
  const Linearisation& about() const { return result_.about; }
  bool stopped() const { return result_.stopped; }
  bool converged() const { return solution_.converged && !result_.stopped; }
  double told_error() const {
    Eigen::VectorXd residual = measured_ - model_forces(result_, experiment_, selection_, false).f;
    if (has_offsets_) take_out_press_means(dataset_, selection_, residual);
    return force_error(dataset_, residual).told();
  }

 private:
  void minimise_all() {
    if (is_linearised_ && options_.rounds > 0)
      minimise_in_rounds();
    else
      minimise_within(1);
  }

  // The field that the places ask for beside all else, and all else beside that field, in turn.
  void minimise_with_field() {
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kFieldRounds && !result_.stopped; ++round) {
      learn_field(result_.model, experiment_, result_.about, selection_, options_.noise,
                  options_.keep_scales || round > 0);
      minimise_all();
      if (before - solution_.sum_of_squares < kFieldSettled * before) break;
      before = solution_.sum_of_squares;
    }
  }

  // Residuals over the noise, and their derivatives, of the model with these values.
  ResidualFunction residuals_of(Model model) const {
    return [this, model = std::move(model)](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                            Eigen::MatrixXd* J) mutable {
      set_values(model, x);
      Signal signal;
      try {
        signal = model_forces(model, experiment_, result_.about, selection_, J != nullptr);
      } catch (const Error& error) {
        // A law without an equilibrium there: a step that far is not taken.
        if (error.code() != ExitCode::kNoConvergence || J != nullptr) throw;
        r.setConstant(rows(), std::numeric_limits<double>::quiet_NaN());
        return;
      }
      // Beside torques and points, forces count over the error of each position too (whiten()).
      const double unit = force_weights_ ? 1 : options_.noise;
      r = (signal.f - measured_) / unit;
      if (J != nullptr) *J = signal.df / unit;
      if (has_offsets_) {
        take_out_press_means(dataset_, selection_, r);
        if (J != nullptr) take_out_press_means(dataset_, selection_, *J);
      }
      if (force_weights_) force_weights_->whiten(r);
      if (force_weights_ && J != nullptr) force_weights_->whiten(*J);
      torques_.append(model, result_.about, signal, r, J);
      marked_.append(model, r, J);
    };
  }

  // Of the residuals, forces, torques and points.
  Eigen::Index rows() const { return measured_.size() + torques_.size() + marked_.size(); }

  // Tells the watch; false when the fit is to end.
  bool go_on(double sum) {
    const double now = options_.noise * std::sqrt(sum / static_cast<double>(rows()));
    if (!(progress_.rmse <= now)) progress_.rmse = now;
    return !options_.watch || options_.watch(progress_);
  }

  void keep_search(const LeastSquaresResult& best, int starts_done) const {
    if (!options_.after_start || starts_done == 0) return;
    Model model = result_.model;
    set_values(model, best.x);
    options_.after_start(model, starts_done);
  }

  std::vector<Unknown> open_within(double reach) const {
    std::vector<Unknown> open = unknowns(result_.model);
    return is_linearised_ ? within_reach(std::move(open), result_.model, reach) : open;
  }

  void take(LeastSquaresResult solution) {
    solution_ = std::move(solution);
    set_values(result_.model, solution_.x);
    result_.stopped = solution_.stopped;
    if (options_.keep)
      options_.keep(result_.model, options_.noise * std::sqrt(solution_.sum_of_squares /
                                                              static_cast<double>(rows())));
  }

  // From many starts, once: later rounds improve on the valley found.
  void search_valleys() {
    Random random(options_.seed);
    const std::vector<Unknown> open = unknowns(result_.model);
    auto starts = latin_hypercube_starts(spread(result_.model, open, experiment_, selection_),
                                         options_.starts, random);
    for (std::vector<Unknown>& one : starts)  // spread so, but bounded as ever
      for (std::size_t i = 0; i < one.size(); ++i) {
        one[i].lower = open[i].lower;
        one[i].upper = open[i].upper;
      }
    // The given start is the first in any case.
    const int skip = std::clamp(options_.skip - 1, 0, options_.starts - 1);
    starts.erase(starts.begin() + 1, starts.begin() + 1 + skip);
    MultiStartResult many = minimise_from_many(starts, residuals_of(result_.model), search_, 0.1,
                                               [&](int number, const LeastSquaresResult& best) {
                                                 progress_.start = number == 0 ? 0 : number + skip;
                                                 if (std::isinf(best.sum_of_squares)) return true;
                                                 keep_search(best, progress_.start);
                                                 return go_on(best.sum_of_squares);
                                               });
    take(std::move(many.best));
    if (result_.stopped) result_.starts_done = many.starts == 0 ? 0 : many.starts + skip;
    from_many_ = false;
  }

  // Within the bounds, and the constraints where there are any.
  LeastSquaresResult solve(const std::vector<Unknown>& open, const ResidualFunction& residuals,
                           const LeastSquaresOptions& search = {}) {
    if (constraints_.empty()) return minimise(open, residuals, search);
    under_ = minimise_under(open, constraints_, residuals, search);
    return under_.fit;
  }

  // All unknowns; those that the body is linear in by no more than `reach` (within_reach()).
  void minimise_within(double reach) {
    if (from_many_) search_valleys();
    if (result_.stopped) return;
    const ResidualFunction residuals = residuals_of(result_.model);
    std::vector<Unknown> open = open_within(reach);
    if (options_.robust != RobustLoss::kNone) {
      RobustResult robust = minimise_robustly(
          open, residuals, options_.robust, search_,
          [this](const auto& from, const auto& of, const auto& by) { return solve(from, of, by); });
      result_.discounted = robust.discounted;
      if (!constraints_.empty() && robust.fit.converged) {
        LeastSquaresOptions look;
        look.max_iterations = 0;
        for (std::size_t i = 0; i < open.size(); ++i)
          open[i].value = robust.fit.x[static_cast<Eigen::Index>(i)];
        robust.fit.covariance =
            robust.spread * minimise_under(open, constraints_, residuals, look).fit.covariance;
      }
      take(std::move(robust.fit));
      return;
    }
    take(solve(open, residuals, search_));
    if (result_.stopped) return;
    if (!constraints_.empty()) {
      Model sorted = result_.model;
      if (!sort_terms(sorted) || !keeps(unknowns(sorted), constraints_)) return;
      result_.model = std::move(sorted);
      take(solve(open_within(reach), residuals, search_));
      return;
    }
    if (sort_terms(result_.model)) {
      open = open_within(reach);
      take(minimise(open, residuals, search_));
    }
    if (!options_.keep_apart || result_.stopped) return;
    keep_terms_apart(result_.model, open, residuals, solution_);
    set_values(result_.model, solution_.x);
  }

  // The sum of squares with the bodies solved for the model's material. What needs no solution is
  // fitted anew: a modulus too large or too small for a new body must not hide that the body has
  // become better.
  double solved_sum() {
    const MaterialSpec material = material_of(result_.model);
    result_.about = experiment_.places.solve(material);
    torques_.solve(material);
    marked_.solve(material);
    const ResidualFunction residuals = residuals_of(result_.model);
    const std::vector<Unknown> open = unknowns(result_.model);
    if (material.modulus.size() == 1) {
      const LeastSquaresResult rest = solve(within_reach(open, result_.model, 0), residuals);
      set_values(result_.model, rest.x);
      return rest.sum_of_squares;
    }
    Eigen::VectorXd x(static_cast<Eigen::Index>(open.size())), r;
    for (std::size_t c = 0; c < open.size(); ++c) x[static_cast<Eigen::Index>(c)] = open[c].value;
    residuals(x, r, nullptr);
    return r.squaredNorm();
  }

  // The finite elements are solved again about each fit; a fit that their solution does not confirm
  // is taken back and tried again closer by (a trust region).
  void minimise_in_rounds() {
    double sum = solved_sum(), reach = 1;
    bool settled = false;
    for (int round = 0; round < options_.rounds && !settled && !result_.stopped; ++round) {
      const Model model_before = result_.model;
      const Linearisation about_before = result_.about;
      minimise_within(reach);
      if (result_.stopped) break;
      const double promised = sum - solution_.sum_of_squares;
      const double now = solved_sum();
      const double least = options_.settled * sum;
      settled = promised < least || (now <= sum && sum - now < least) || reach < kLeastReach;
      if (now <= sum) {
        sum = now;
        result_.stopped = !go_on(sum);
        continue;
      }
      result_.model = model_before;
      result_.about = about_before;
      reach /= 4;
    }
    // Bounds and covariance without the limits of the steps.
    LeastSquaresOptions once;
    once.max_iterations = constraints_.empty() ? 1 : 0;
    const bool converged = solution_.converged && settled;
    const std::string message = solution_.message;
    solution_ = solve(unknowns(result_.model), residuals_of(result_.model), once);
    solution_.converged = converged || options_.rounds < kFullRounds;
    solution_.message = converged ? message : "the body does not settle";
    solution_.sum_of_squares = sum;
  }

  // What is told of the model where the fit has ended.
  void finish() {
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
    if (force_weights_) errors.floor = 0;  // it is in the weights
    set_standard_errors(result_, solution_, signal, experiment_, selection_, errors, variance);
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
  }

  // What the active ones cost, and what they leave to be known.
  void tell_constraints(const Eigen::MatrixXd& J, double variance) {
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

  const Experiment& experiment_;
  const Dataset& dataset_;
  const Selection& selection_;
  const FitOptions& options_;
  const std::vector<SmoothConstraint> constraints_;
  const Eigen::VectorXd measured_;
  const bool has_offsets_, learns_field_;
  TorqueRows torques_;
  MarkerRows marked_;
  std::optional<Weights> force_weights_;
  bool is_linearised_ = false;
  FitProgress progress_;
  LeastSquaresOptions search_;
  bool from_many_;
  LeastSquaresResult solution_;
  UnderConstraints under_;  // of the last search, where there are constraints
  Fit result_;
};

}  // namespace

Fit as_it_is(const Model& model, const Experiment& experiment) {
  Fit result;
  result.model = model;
  result.about = experiment.places.solve(material_of(model));
  return result;
}

Signal model_forces(const Fit& fitted, const Experiment& experiment, const Selection& selection,
                    bool derivatives) {
  return model_forces(fitted.model, experiment, fitted.about, selection, derivatives);
}

namespace {

Fit fit_from(const Model& start, const Experiment& experiment, const Selection& selection,
             const FitOptions& options, const Linearisation& known) {
  Fitting without(start, experiment, selection, options, known);
  without.search();
  const BoundConstraints own = bind_constraints(without.model(), options.constraints);
  if (own.among.empty() || without.stopped()) return without.end();
  const auto named = [&](Fit fitted, double error) {
    fitted.constraints.resize(own.number.size());
    for (std::size_t k = 0; k < own.number.size(); ++k)
      fitted.constraints[k].text = options.constraints[own.number[k]].text;
    fitted.unconstrained = error;
    fitted.starts_done = options.starts;
    return fitted;
  };
  if (without.converged() && keeps(without.model(), own)) {
    Fit kept = without.end();
    const double error = kept.error.told();
    return named(std::move(kept), error);
  }
  if (!feasible_point(unknowns(without.model()), own.among)) {
    Fit broken = without.end();
    broken.converged = false;
    broken.message = conflict_words(broken.model, options.constraints) + " contradict each other";
    return named(std::move(broken), std::nan(""));
  }
  FitOptions more = options;
  more.starts = 1;
  more.skip = 0;
  more.after_start = nullptr;
  Fitting under(without.model(), experiment, selection, more, without.about(), own.among);
  under.search();
  Fit kept = under.end();
  constexpr double kNear = 1e-7;
  if (kept.converged && !keeps(unknowns(kept.model), own.among, kNear)) {
    kept.converged = false;
    kept.message = "the constraints are not kept";
  }
  return named(std::move(kept), without.converged() ? without.told_error() : std::nan(""));
}

}  // namespace

Fit fit(const Model& start, const Experiment& experiment, const Selection& selection,
        const FitOptions& options, const Linearisation& known) {
  const bool torques = options.torques && has_torques(experiment.dataset.recording);
  if (!torques && options.markers == nullptr)
    return fit_from(start, experiment, selection, options, known);
  // The forces alone come first: they say how large each position's errors are in newtons.
  FitOptions forces = options;
  forces.torques = forces.profile = false;
  forces.markers = nullptr;
  Fit alone = fit_from(start, experiment, selection, forces, known);
  if (!alone.converged) return alone;
  FitOptions beside = options;
  // A model that leaves more than noise is wrong in shape, not in gains: against its misfit the
  // error of each position is small, and the weights are those of the forces alone.
  beside.noise = std::max(options.noise, alone.error.pooled);
  beside.starts = 1;
  beside.skip = 0;
  beside.after_start = nullptr;
  Fit both = fit_from(alone.model, experiment, selection, beside, alone.about);
  both.starts_done = options.starts;
  return both;
}

}  // namespace hapsim
