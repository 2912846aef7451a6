#include "fit/fitting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "estimate/feasible.h"
#include "estimate/multi_start.h"
#include "fit/constraints.h"
#include "fit/extend.h"
#include "fit/fit_uncertainty.h"
#include "fit/learned_field.h"
#include "fit/maxwell_terms.h"
#include "fit/move_limits.h"
#include "fit/press_offsets.h"
#include "model/body_parameters.h"

namespace hapsim {
namespace {

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

}  // namespace

Fitting::Fitting(const Model& start, const Experiment& experiment, const Selection& selection,
                 const FitOptions& options, const Linearisation& known,
                 const std::vector<SmoothConstraint>& constraints)
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
  is_linearised_ = (is_linearised(asked, options.exact_regions) ||
                    (options.exact_regions && experiment.places.has_labels(asked))) &&
                   (options.rounds > 0 || result_.about.is_solved_for(asked));
  if (options.watch) search_.watch = [this](double sum) { return go_on(sum); };
  // Steps of a linearised body have a reach, within which the constraints are to have a point.
  if (constraints_.empty() || !is_linearised_) return;
  if (const auto point = feasible_point(unknowns(result_.model), constraints_))
    set_unknowns(result_.model, *point);
}

void Fitting::search() {
  if (learns_field_)
    minimise_with_field();
  else
    minimise_all();
}
void Fitting::minimise_all() {
  if (is_linearised_ && options_.rounds > 0)
    minimise_in_rounds();
  else
    minimise_within(1);
}

void Fitting::minimise_with_field() {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kFieldRounds && !result_.stopped; ++round) {
    learn_field(result_.model, experiment_, result_.about, selection_, options_.noise,
                options_.keep_scales || round > 0);
    minimise_all();
    if (before - solution_.sum_of_squares < kFieldSettled * before) break;
    before = solution_.sum_of_squares;
  }
}

ResidualFunction Fitting::residuals_of(Model model) const {
  return [this, model = std::move(model)](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                          Eigen::MatrixXd* J) mutable {
    set_unknowns(model, x);
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

bool Fitting::go_on(double sum) {
  const double now = options_.noise * std::sqrt(sum / static_cast<double>(rows()));
  if (!(progress_.rmse <= now)) progress_.rmse = now;
  return !options_.watch || options_.watch(progress_);
}

void Fitting::keep_search(const LeastSquaresResult& best, int starts_done) const {
  if (!options_.after_start || starts_done == 0) return;
  Model model = result_.model;
  set_unknowns(model, best.x);
  options_.after_start(model, starts_done);
}

std::vector<Unknown> Fitting::open_within(double reach) const {
  std::vector<Unknown> open = unknowns(result_.model);
  return is_linearised_ ? within_reach(std::move(open), result_.model, reach) : open;
}

void Fitting::take(LeastSquaresResult solution) {
  solution_ = std::move(solution);
  set_unknowns(result_.model, solution_.x);
  result_.stopped = solution_.stopped;
  if (options_.keep)
    options_.keep(result_.model, options_.noise * std::sqrt(solution_.sum_of_squares /
                                                            static_cast<double>(rows())));
}

void Fitting::search_valleys() {
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

LeastSquaresResult Fitting::solve(const std::vector<Unknown>& open,
                                  const ResidualFunction& residuals,
                                  const LeastSquaresOptions& search) {
  if (constraints_.empty()) return minimise(open, residuals, search);
  under_ = minimise_under(open, constraints_, residuals, search);
  return under_.fit;
}

void Fitting::minimise_within(double reach) {
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
  set_unknowns(result_.model, solution_.x);
}

double Fitting::solved_sum() {
  const MaterialSpec material = material_of(result_.model);
  result_.about = experiment_.places.solve(material);
  torques_.solve(material);
  marked_.solve(material);
  const ResidualFunction residuals = residuals_of(result_.model);
  const std::vector<Unknown> open = unknowns(result_.model);
  if (material.modulus.size() == 1) {
    const LeastSquaresResult rest = solve(within_reach(open, result_.model, 0), residuals);
    set_unknowns(result_.model, rest.x);
    return rest.sum_of_squares;
  }
  Eigen::VectorXd r;
  residuals(values_of(open), r, nullptr);
  return r.squaredNorm();
}

void Fitting::minimise_in_rounds() {
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

double Fitting::told_error() const {
  Eigen::VectorXd residual = measured_ - model_forces(result_, experiment_, selection_, false).f;
  if (has_offsets_) take_out_press_means(dataset_, selection_, residual);
  return force_error(dataset_, residual).told();
}

}  // namespace hapsim
