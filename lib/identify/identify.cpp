#include "identify/identify.h"

#include <cmath>
#include <span>

#include "base/error.h"
#include "diagnose/wording.h"
#include "experiment/plausible.h"
#include "fit/boundary_fit.h"
#include "fit/constraint_regions.h"
#include "fit/constraints.h"
#include "fit/fit_record.h"
#include "fit/fit_words.h"
#include "fit/held_out_band.h"
#include "fit/marker_rows.h"
#include "fit/ridge.h"
#include "fit/torque_rows.h"
#include "io/number.h"
#include "model/model_edit.h"
#include "model/search_state.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

// Adds what a diagnosis finds missing, step by step.
Improvement improve_step_by_step(const IdentifyRequest& request, const TetMesh& body,
                                 ExperimentOptions options, const FitOptions& fit_options,
                                 const Experiment& w, double force_rms) {
  options.draft = true;
  options.progress = nullptr;
  const Experiment draft = make_experiment(std::span(&body, 1), w.dataset, options);
  ImproveOptions improve_options;
  improve_options.fit = fit_options;
  improve_options.diagnose.folds = request.folds;
  improve_options.diagnose.seed = fit_options.seed;
  improve_options.progress = request.tell;
  improve_options.diagnose.progress = request.progress;
  Model start = request.fit.start;
  if (start.parameters.empty()) {
    start = elastic_model(w, all_episodes(w.dataset));
    for (const std::string& what : request.fit.fix) set_state(start, what, ParameterState::kFixed);
  }
  Improvement improvement = improve(start, w, draft, improve_options);
  for (std::size_t k = 0; k < improvement.steps.size(); ++k) {
    const ImprovementStep& step = improvement.steps[k];
    if (request.say) request.say(step_words(step, w.noise.value));
    if (request.step && k + 1 < improvement.steps.size())
      request.step(step, improvement.unseen, force_rms);
  }
  return improvement;
}

}  // namespace

FitOptions each_fit(const IdentifyRequest& request, const Experiment& w) {
  FitOptions options = request.options;
  options.noise = w.noise.value;
  options.floor = w.floor;
  options.skip = 0;
  options.after_start = nullptr;
  options.profile = false;
  options.markers = nullptr;
  return options;
}

Identification identify(const IdentifyRequest& request, const TetMesh& body, const Experiment& w,
                        ExperimentOptions options) {
  if (request.options.profile && request.options.robust != RobustLoss::kNone)
    fail_usage("--profile and --robust exclude each other",
               "a robust loss is no likelihood: use one of them");
  if (request.options.profile && !request.options.constraints.empty())
    fail_usage("--profile and --constrain exclude each other",
               "standard errors are along what the constraints leave free: use one of them");
  if (request.fit.automatic && !request.options.constraints.empty())
    fail_usage("--constrain needs the model's effects, which 'auto' finds out",
               "find them first, then go on with --model and --constrain");
  FitOptions fit_options = each_fit(request, w);
  FitOptions final_options = request.options;
  final_options.noise = fit_options.noise;
  final_options.floor = fit_options.floor;
  final_options.torques = true;
  final_options.ridges = true;
  ExtendOptions extend;
  extend.regions = request.regions;
  extend.terms = request.fit.terms.count;
  extend.noise = w.noise.value;
  extend.floor = w.floor;

  const Selection all = all_episodes(w.dataset);
  Identification result;
  const auto refine = [&] {
    result.fitted = request.refine(result.fitted);
    result.fitted.torque = torque_error(result.fitted, w, all, final_options);
    result.fitted.marker = marker_error(result.fitted, w, all, final_options);
  };
  result.force_rms = force_error(w.dataset, measured_forces(w.dataset, all)).told();
  ForceError unseen;
  if (request.fit.automatic) {
    Improvement improvement =
        improve_step_by_step(request, body, std::move(options), fit_options, w, result.force_rms);
    result.fitted = std::move(improvement.steps.back().fitted);
    unseen = improvement.steps.back().held_out;
    result.band = improvement.steps.back().band;
    // The search compares effects by their forces; what it has found is fitted to torques and
    // points as well, and sizes that hardly show have errors that hold.
    if ((has_torques(w.dataset.recording) || final_options.markers != nullptr ||
         has_ridges(result.fitted.model)) &&
        !improvement.stopped) {
      final_options.starts = 1;
      final_options.skip = 0;
      Fit both = fit(result.fitted.model, w, all, final_options, result.fitted.about);
      if (both.converged) result.fitted = std::move(both);
    }
    if (!improvement.stopped && request.refine && has_boundaries(result.fitted.model)) refine();
    if (improvement.stopped)
      result.cut_short = "the model was improved";
    else
      result.ended = end_words(improvement);
    result.unseen_by = improvement.unseen;
  } else {
    Starts starts = build_starts(request.fit, w, all, fit_options, extend);
    require_enough_data(starts.models.front(), w.dataset, all);
    Model named = starts.models.front();
    named.metadata = request.fit.start.metadata;
    final_options.constraints = fit_options.constraints =
        number_regions(fit_options.constraints, named, body);
    require_constraints(starts.models.front(), fit_options.constraints);
    if (request.starts) request.starts(starts.models);
    result.fitted = fit_best(starts.models, w, all, final_options, starts.known);
    if (request.refine && result.fitted.converged) refine();
  }
  if (result.fitted.stopped) return result;
  if (!result.fitted.converged)
    fail_numerics(w.dataset.recording.name, "the fit did not converge: " + result.fitted.message,
                  "start from a simpler model, or fix a parameter");
  if (request.folds > 1 && !request.fit.automatic &&
      !(request.interrupted && request.interrupted())) {
    const Folds folds = make_folds(w.dataset, request.folds);
    result.unseen_by = folds.by;
    const HeldOut held_out =
        held_out_error(request.fit, result.fitted.model, w, folds, fit_options, extend);
    unseen = held_out.error;
    result.band = held_out_band(held_out, folds, w, w.allowance(), result.fitted);
  }
  if (request.end && request.end() && result.cut_short.empty()) {
    result.cut_short = "the error on unseen data was found";
    unseen = {};
    result.band = {};
  }
  result.unseen = unseen.told();
  Model& model = result.fitted.model;
  record_fit(result.fitted, request.fit.start.metadata, w);
  record_band(result.band, model.metadata);
  if (!std::isnan(result.unseen)) {
    model.metadata.set("heldout", format_number(result.unseen));
    model.metadata.set("heldout_by", result.unseen_by);
  }
  if (!result.cut_short.empty()) mark_interrupted(model, "while " + result.cut_short);
  return result;
}

Summary identification_summary(const Identification& i, const Experiment& w) {
  Summary summary = fit_summary(w, i.fitted, i.unseen, i.unseen_by, i.force_rms);
  if (i.band.known()) {
    summary.items.front().facts.push_back(band_words(i.band));
    summary.values.push_back({"unseen_band", i.band.share, "1"});
    summary.values.push_back({"unseen_chance", i.band.chance, "1"});
  }
  if (!i.ended.empty()) summary.notes.insert(summary.notes.begin(), i.ended);
  return summary;
}

}  // namespace hapsim
