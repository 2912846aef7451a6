#include "fit/fit.h"

#include <algorithm>
#include <cmath>

#include "estimate/feasible.h"
#include "fit/constraints.h"
#include "fit/fit_uncertainty.h"
#include "fit/fitting.h"
#include "recording/torque_columns.h"

namespace hapsim {

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
