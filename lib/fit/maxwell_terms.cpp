#include "fit/maxwell_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "effects/catalogue.h"
#include "estimate/constrained.h"

namespace hapsim {
namespace {

// An effect's rows, term by term; `time` is the place of the relaxation time within a term.
struct Terms {
  std::string effect;
  std::vector<std::vector<std::size_t>> rows;  // of the model's parameters
  std::size_t time = 0;
};

std::vector<Terms> terms_of(const Model& model) {
  std::vector<Terms> result;
  for (const std::string& name : model.effects()) {
    const EffectCard& card = require_effect(name).card();
    if (!card.terms || card.is_map) continue;
    Terms terms{name, {}, card.parameters.size()};
    for (std::size_t k = 0; k < card.parameters.size(); ++k)
      if (card.parameters[k].unit == "s") terms.time = k;
    if (terms.time == card.parameters.size()) continue;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      if (model.parameters[i].effect != name) continue;
      rows.push_back(i);
      if (rows.size() < card.parameters.size()) continue;
      terms.rows.push_back(rows);
      rows.clear();
    }
    result.push_back(terms);
  }
  return result;
}

bool alike(const Parameter& a, const Parameter& b) {
  return a.lower == b.lower && a.upper == b.upper && a.state == b.state;
}

bool ordered(const Model& model, const Terms& t, double ratio) {
  for (std::size_t k = 1; k < t.rows.size(); ++k)
    if (model.parameters[t.rows[k][t.time]].value <
        ratio * model.parameters[t.rows[k - 1][t.time]].value)
      return false;
  return true;
}

bool interchangeable(const Model& model, const Terms& t) {
  for (const auto& rows : t.rows)
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (!alike(model.parameters[rows[i]], model.parameters[t.rows.front()[i]])) return false;
  return true;
}

}  // namespace

bool sort_terms(Model& model) {
  bool changed = false;
  for (const Terms& t : terms_of(model)) {
    if (ordered(model, t, 1) || !interchangeable(model, t)) continue;
    std::vector<std::size_t> order(t.rows.size());
    std::iota(order.begin(), order.end(), 0);
    const auto time = [&](std::size_t k) { return model.parameters[t.rows[k][t.time]].value; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return time(a) < time(b); });
    const Model before = model;
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t i = 0; i < t.rows[k].size(); ++i)
        model.parameters[t.rows[k][i]].value = before.parameters[t.rows[order[k]][i]].value;
    changed = true;
  }
  return changed;
}

void keep_terms_apart(const Model& model, const std::vector<Unknown>& open,
                      const ResidualFunction& residuals, LeastSquaresResult& solution) {
  const std::vector<int> free = model.free_parameters();
  std::vector<LinearConstraint> constraints;
  std::vector<Unknown> start = open;
  for (std::size_t i = 0; i < start.size(); ++i)
    start[i].value = solution.x[static_cast<Eigen::Index>(i)];
  for (const Terms& t : terms_of(model)) {
    std::vector<std::size_t> times;
    for (const auto& rows : t.rows) {
      const auto found = std::find(free.begin(), free.end(), static_cast<int>(rows[t.time]));
      if (found != free.end()) times.push_back(static_cast<std::size_t>(found - free.begin()));
    }
    if (times.size() != t.rows.size() || ordered(model, t, kApart) || !interchangeable(model, t))
      continue;
    for (LinearConstraint& c : keep_apart(open.size(), times, kApart))
      constraints.push_back(std::move(c));
    // A start that keeps them, within the bounds.
    for (std::size_t k = 1; k < times.size(); ++k)
      start[times[k]].value =
          std::min(start[times[k]].upper,
                   std::max(start[times[k]].value, 1.5 * kApart * start[times[k - 1]].value));
  }
  if (constraints.empty()) return;
  ConstrainedResult apart = minimise_constrained(start, constraints, residuals);
  if (!apart.fit.converged) {
    // A term that the data do not hold leaves no curvature to the constrained solver: disjoint
    // windows about the starts' geometric means then do the same.
    for (const LinearConstraint& c : constraints)
      for (std::size_t later = 0; later < start.size(); ++later) {
        if (c.coefficient[later] != 1) continue;
        const auto one = std::find(c.coefficient.begin(), c.coefficient.end(), -1.0);
        const auto before = static_cast<std::size_t>(one - c.coefficient.begin());
        const double middle = std::sqrt(start[before].value * start[later].value);
        start[before].upper = std::min(start[before].upper, middle / std::sqrt(kApart));
        start[later].lower = std::max(start[later].lower, middle * std::sqrt(kApart));
      }
    apart.fit = minimise(start, residuals);
  }
  if (apart.fit.converged) solution = std::move(apart.fit);
}

void set_windows(Model& model, const std::string& effect, const TimeWindows& windows) {
  for (std::size_t k = 0; k < windows.size(); ++k)
    if (windows[k].first >= windows[k].second ||
        (k > 0 && windows[k].first < windows[k - 1].second))
      fail_usage("the windows of the relaxation times overlap or do not ascend",
                 "give disjoint ones from short to long: 0.05:1,2:30");
  for (const Terms& t : terms_of(model)) {
    if (t.effect != effect) continue;
    if (t.rows.size() != windows.size())
      fail_usage(fmt::format("{} windows for {} terms", windows.size(), t.rows.size()),
                 "give one window a term");
    for (std::size_t k = 0; k < windows.size(); ++k) {
      Parameter& p = model.parameters[t.rows[k][t.time]];
      p.lower = windows[k].first;
      p.upper = windows[k].second;
      if (p.value <= p.lower || p.value >= p.upper) p.value = std::sqrt(p.lower * p.upper);
    }
  }
}

TermChoice choose_terms(const Fit& base, const std::string& effect, int most,
                        const Experiment& experiment, const Selection& selection,
                        const FitOptions& fit_options, const ExtendOptions& options) {
  const Dataset& dataset = experiment.dataset;
  const Folds all_folds = make_folds(dataset, 6);
  TermChoice choice;
  for (int terms = 1; terms <= most; ++terms) {
    ExtendOptions extend = options;
    extend.terms = terms;
    TermTrial trial;
    trial.terms = terms;
    trial.fit = fit_best(with_effect(base, effect, experiment, selection, extend), experiment,
                         selection, fit_options, base.about);
    const double n = static_cast<double>(trial.fit.residuals);
    trial.criterion = 2 * n * std::log(trial.fit.error.pooled) +
                      static_cast<double>(trial.fit.model.free_parameters().size()) * std::log(n);
    if (all_folds.held_out.size() > 1 && selection.size() == dataset.episodes.size()) {
      const ModelBuilder same = [&](const Selection&) {
        return Starts{{trial.fit.model}, trial.fit.about};
      };
      FitOptions quick = fit_options;
      quick.exact_regions = false;
      quick.starts = 1;
      trial.held_out = held_out_error(same, experiment, all_folds, quick).error;
    }
    choice.trials.push_back(trial);
    if (terms == 1) {
      choice.terms = 1;
      continue;
    }
    const TermTrial& before = choice.trials[choice.trials.size() - 2];
    const bool better = trial.fit.converged && trial.criterion < before.criterion - kWorthATerm &&
                        !(trial.held_out.pooled >= before.held_out.pooled);
    if (!better) break;
    choice.terms = terms;
  }
  return choice;
}

std::vector<std::string> untold_times(const Model& model, const Dataset& dataset) {
  constexpr double kTold = 1.0 / 3;  // else zero lies within three standard errors
  double longest = 0;
  for (const Episode& e : dataset.episodes)
    if (!e.view.t.empty()) longest = std::max(longest, e.view.t.back());
  std::vector<std::string> result;
  for (const Terms& t : terms_of(model)) {
    for (const auto& rows : t.rows) {
      const Parameter& p = model.parameters[rows[t.time]];
      if (p.state != ParameterState::kFree) continue;
      const bool uncertain = !(p.std_error <= kTold * p.value);
      if (!uncertain && p.value <= longest) continue;
      result.push_back(fmt::format(
          "{} {} = {:.3g} s is not identifiable from these data: {}; hold longer, or fix it",
          p.effect, p.name, p.value,
          p.value > longest
              ? fmt::format("the longest press lasts {:.3g} s, and slower relaxation counts as E",
                            longest)
          : std::isnan(p.std_error) ? "no standard error can be given"
                                    : fmt::format("its standard error is {:.2g} s", p.std_error)));
    }
    if (result.empty() && t.rows.size() == 1)
      result.push_back(fmt::format(
          "relaxation slower than {:.3g} s is not identifiable from these data: the longest press "
          "lasts so long, and what relaxes later counts as E",
          longest));
  }
  return result;
}

}  // namespace hapsim
