#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "fit/fit.h"
#include "fit/move_limits.h"

namespace hapsim {
namespace {

// The start in whose valley an estimate lies: the fewest typical changes away.
const Model& nearest_start(const std::vector<Model>& starts, const Model& model) {
  const auto distance = [&](const Model& start) {
    double sum = 0;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const Parameter& p = model.parameters[i];
      const ParameterCard* card = parameter_card(require_effect(p.effect), p.name);
      const double from = start.parameters[i].value;
      const double change =
          card->logarithmic ? std::log(p.value / from) : (p.value - from) / card->scale;
      sum += change * change;
    }
    return sum;
  };
  return *std::min_element(starts.begin(), starts.end(), [&](const Model& a, const Model& b) {
    return distance(a) < distance(b);
  });
}

bool better_than(const Fit& a, const Fit& b) {
  return a.converged != b.converged ? a.converged : a.error.pooled < b.error.pooled;
}

}  // namespace

Fit fit_solved(const Model& estimate, const std::vector<Model>& starts,
               const Experiment& experiment, const Selection& selection,
               const FitOptions& options) {
  constexpr double kLeaves = 1.3;  // times the noise: not what is meant
  constexpr int kGlance = 2;       // rounds, to see whether the start is better
  Fit fitted = fit(estimate, experiment, selection, options);
  if (fitted.stopped || (fitted.converged && fitted.error.pooled < kLeaves * options.noise))
    return fitted;
  FitOptions glance = options;
  glance.rounds = std::min(options.rounds, kGlance);
  glance.starts = 1;
  Fit anew = fit(nearest_start(starts, estimate), experiment, selection, glance);
  if (!anew.stopped && (anew.error.pooled < fitted.error.pooled || !fitted.converged)) {
    glance.rounds = options.rounds;
    anew = fit(anew.model, experiment, selection, glance);
    if (better_than(anew, fitted)) fitted = std::move(anew);
  }
  return fitted;
}

Fit fit_best(const std::vector<Model>& starts, const Experiment& experiment,
             const Selection& selection, const FitOptions& options, const Linearisation& known) {
  // Where each fit costs finite-element solutions, estimates choose the start.
  FitOptions each = options;
  const bool choose = starts.size() > 1 && is_linearised(material_of(starts[0]), false);
  if (choose) each.rounds = 0;
  // All starts have the same bounds, over which the others are spread: one search is enough.
  const bool search = starts.size() > 1 && options.starts > 1;
  if (search) each.starts = 1;
  Fit best;
  bool found = false;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    Fit result;
    try {
      result = fit(starts[s], experiment, selection, each, known);
    } catch (const Error& error) {  // a start without forces; another one may have them
      const bool last = s + 1 == starts.size() && !found;
      if (error.code() != ExitCode::kNoConvergence || last) throw;
      continue;
    }
    const bool better =
        !found || (result.converged && !best.converged) ||
        (result.converged == best.converged && result.error.pooled < best.error.pooled);
    const bool stopped = result.stopped;
    if (better) best = std::move(result);
    found = true;
    if (!stopped) continue;
    best.stopped = true;
    best.converged = false;
    best.message = "interrupted";
    if (search) best.starts_done = 0;
    return best;
  }
  if (choose && options.rounds > each.rounds)
    return fit_solved(best.model, starts, experiment, selection, options);
  return search ? fit(best.model, experiment, selection, options, known) : best;
}

}  // namespace hapsim
