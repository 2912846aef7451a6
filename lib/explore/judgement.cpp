#include "explore/judgement.h"

#include <cmath>

#include "base/error.h"
#include "diagnose/draft_experiment.h"
#include "diagnose/held_out.h"
#include "diagnose/wording.h"
#include "fit/boundary_fit.h"
#include "fit/extend.h"

namespace hapsim {
namespace {

// Boundaries are found to first order. Where one leaves more than noise it is moved together with
// the moduli, as hs-identify --refine-boundary does.
void refine_what_is_found(const TetMesh& body, const TrialGround& ground,
                          const ExploreOptions& options, Diagnosis& d) {
  constexpr int kKeyPoints = 8;
  if (d.verdict != ModelVerdict::kIncomplete || d.left.noise_alone() ||
      !has_boundaries(d.rivals.front()))
    return;
  options.diagnose.tell("moving boundaries");
  BoundaryOptions moving;
  moving.key_points = kKeyPoints;
  moving.threads = options.experiment.threads;
  moving.fit = trial_fit_options(ground);
  try {
    const Fit found = fit(d.rivals.front(), ground.experiment, all_episodes(ground.dataset),
                          trial_fit_options(ground));
    BoundaryFit moved = refine_boundaries(found, ground.experiment, body, moving);
    if (!moved.better) return;
    d.rmse_end = moved.fitted.error;
    d.left = left_over(moved.fitted, ground);
    d.rivals.front() = std::move(moved.fitted.model);
    d.explanation = explain_verdict(d, ground.experiment.noise);
  } catch (const Error& error) {  // none lies on the body
    if (error.code() != ExitCode::kBadInput) throw;
  }
}

void judge_forces(const Model& start, const TetMesh& body, const TrialGround& ground,
                  const ExploreOptions& options, Judgement& known) {
  known.diagnosis = diagnose(start, known.experiment, ground.allowance, options.diagnose);
  refine_what_is_found(body, ground, options, *known.diagnosis);
  const Diagnosis& d = *known.diagnosis;
  known.goals.push_back(verdict_state(d, known.coverage));
  known.settled = known.goals.back().reached;
  // An error is none of a model that lacks something, and not asked for before.
  for (const WantedError& wanted : options.goals.errors) {
    const std::optional<GoalState> never = hopeless(wanted, ground.allowance.floor);
    if (known.settled)
      known.goals.push_back(error_state(wanted, d.rivals.front(), ground.allowance.floor));
    else
      known.goals.push_back(never ? *never
                                  : GoalState{wanted.parameter, "", std::nan(""), wanted.share});
  }
  if (options.goals.unseen.value > 0) {
    options.diagnose.tell("leaving places out");
    known.left_out = places_left_out(d.rivals.front(), known.experiment, ground.allowance);
  }
}

bool has_one_modulus(const Model& model) {
  const MaterialSpec material = material_of(model);
  return material.modulus.size() <= 1 && material.features.empty();
}

StiffnessImage image_of(const Fit& fitted, const Experiment& experiment, const TetMesh& body,
                        const ExploreOptions& asked) {
  ImageOptions options;
  options.threads = asked.experiment.threads;
  return stiffness_image(fitted.model, experiment, fitted.about, body, options);
}

}  // namespace

Judgement judge(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
                const Recording& recording, const ExploreOptions& options) {
  Judgement known{draft_experiment(body, window, model, recording, options.experiment)};
  Model start = model;
  const Experiment& e = known.experiment;
  const TrialGround ground(e, e.allowance());
  const Selection all = all_episodes(e.dataset);
  known.coverage = coverage_of(e.dataset);
  known.coverage.presses = recording.presses().size();
  if (start.parameters.empty()) start = elastic_model(e, all);
  if (options.goals.of_forces()) judge_forces(start, body, ground, options, known);
  known.fitted = fit(start, e, all, trial_fit_options(ground));
  if (!known.fitted->converged)
    fail_numerics(recording.name, "the model does not fit: " + known.fitted->message,
                  "give another one by --model");
  known.seen = seen_places(*known.fitted, e);
  if (!(options.goals.lump > 0)) return known;
  if (known.seen.size() >= kSettledPlaces) {
    if (!has_one_modulus(known.fitted->model))
      fail_input("", "a lump is looked for in a body of one modulus",
                 "give a model without regions, layers and inclusions, or none");
    options.diagnose.tell("looking inside");
    known.image = image_of(*known.fitted, e, body, options);
  }
  known.goals.push_back(
      lump_state(options.goals.lump, known.image ? *known.image : StiffnessImage{}));
  return known;
}

std::optional<StiffnessImage> sight_of(const Judgement& known, const TetMesh& body,
                                       const ExploreOptions& options) {
  if (known.image) return known.image;
  if (!known.diagnosis || !has_one_modulus(known.diagnosis->rivals.front())) return std::nullopt;
  options.diagnose.tell("looking how deep these presses see");
  const Experiment& e = known.experiment;
  try {
    const Fit complete = fit(known.diagnosis->rivals.front(), e, all_episodes(e.dataset),
                             trial_fit_options(TrialGround(e, e.allowance())));
    return image_of(complete, e, body, options);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace hapsim
