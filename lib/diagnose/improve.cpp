#include "diagnose/improve.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "diagnose/foretold.h"
#include "diagnose/held_out.h"
#include "effects/catalogue.h"
#include "fit/held_out_band.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

ImprovementStep fitted_step(const std::string& added, const std::vector<Model>& starts,
                            const TrialGround& g, const Folds& folds,
                            const ImproveOptions& options) {
  ImprovementStep step;
  step.added = added;
  step.fitted = fit_best(starts, g.experiment, all_episodes(g.dataset), options.fit);
  if (step.fitted.converged && !folds.held_out.empty()) {
    const HeldOut held_out = held_out_of(step.fitted, g, folds, Map::kAnew);
    step.held_out = held_out.error;
    step.band = held_out_band(held_out, folds, g.experiment, g.allowance, step.fitted);
  }
  return step;
}

// Of the error on what is unseen, judged as the diagnosis judged it, by the effect that `after` has
// more.
double remaining(const ImprovementStep& before, const ImprovementStep& after,
                 const Finding& finding, const TrialGround& g, const Folds& folds) {
  const Model& model = before.fitted.model;
  const auto by = [&](const Folds& parts, Map map) {
    return held_out_of(after.fitted, g, parts, map).error.pooled /
           held_out_of(before.fitted, g, parts, map).error.pooled;
  };
  if (finding.by_presses)
    return by(make_press_folds(g.dataset, static_cast<int>(folds.held_out.size())), Map::kAnew);
  if (!has_map(model) || require_effect(after.added).card().is_map)
    return after.held_out.pooled / before.held_out.pooled;
  return by(folds, Map::kKnown);
}

Forecasts::Names added_by(const std::vector<ImprovementStep>& steps) {
  Forecasts::Names names;
  for (const ImprovementStep& step : steps)
    if (!step.added.empty()) names.push_back(step.added);
  std::sort(names.begin(), names.end());
  return names;
}

std::string refused_of(const std::vector<ImprovementStep>& steps, std::size_t from) {
  std::string names;
  for (std::size_t k = from; k < steps.size(); ++k)
    names += (names.empty() ? "" : ", ") + steps[k].added;
  return names;
}

// What is missing; also a field that is learned from what each place asks for, where the data
// cannot tell it from a cause: it states none, and foretells. What stands for another cause is no
// name of it, and foretells as well.
bool is_to_be_added(const Finding& finding) {
  return finding.verdict == Verdict::kMissing || finding.doubted ||
         (finding.verdict == Verdict::kIndistinguishable &&
          require_effect(finding.effect).card().is_field);
}

// What is to be added, in order. Of few presses, where none is: the first curve of no law that is
// possible and foretells what was unseen; it states no cause either.
std::vector<const Finding*> to_be_added(const Diagnosis& diagnosis, Judge* judge,
                                        const Forecasts::Names& added) {
  std::vector<const Finding*> result;
  for (const Finding& finding : diagnosis.findings)
    if (is_to_be_added(finding)) result.push_back(&finding);
  if (!result.empty() || judge == nullptr) return result;
  for (const Finding& finding : diagnosis.findings) {
    if (finding.verdict != Verdict::kPossible || !require_effect(finding.effect).card().learned)
      continue;
    Forecasts::Names with = added;
    with.insert(std::upper_bound(with.begin(), with.end(), finding.effect), finding.effect);
    if (judge->admits(judge->of(added, with))) return {&finding};
  }
  return result;
}

struct Ended {};  // by the watch of the fits

}  // namespace

Improvement improve(const Model& start, const Experiment& fine, const Experiment& draft,
                    const ImproveOptions& options) {
  const auto tell = [&](const std::string& what) {
    if (options.progress) options.progress(what);
  };
  const TrialGround ground(fine, fine.allowance());
  const Selection all = all_episodes(fine.dataset);
  const bool few = fine.dataset.episodes.size() < kLeastPresses;
  const Folds folds = few ? Folds{} : make_folds(fine.dataset, options.diagnose.folds);
  ExtendOptions extend;
  extend.noise = fine.noise.value;
  extend.floor = fine.floor;
  Improvement result;
  result.by_rest = few;
  result.unseen = few ? unseen_by(fine.dataset, options.diagnose.folds) : folds.by;
  const Model first = start.parameters.empty() ? elastic_model(fine, all) : start;
  tell("fitting " + effects_label(first));
  result.steps.push_back(fitted_step("", {first}, ground, folds, options));
  result.stopped = result.steps.front().fitted.stopped;
  if (result.stopped) return result;
  if (!result.steps.front().fitted.converged)
    fail_numerics(fine.dataset.recording.name,
                  "the fit did not converge: " + result.steps.front().fitted.message,
                  "start from a simpler model, or fix a parameter");
  std::optional<Judge> judge;
  if (few) {
    judge.emplace(result.steps.front().fitted, ground, options.diagnose);
    result.steps.front().held_out = judge->error({});
  }
  DiagnoseOptions watched = options.diagnose;
  watched.progress = [&](const std::string& what, std::size_t k, std::size_t n) {
    options.diagnose.tell(what, k, n);
    if (options.fit.watch && !options.fit.watch({})) throw Ended{};
  };
  for (int k = 0; k < options.most_diagnoses; ++k) {
    tell("diagnosing " + effects_label(result.steps.back().fitted.model));
    try {
      result.last = diagnose(result.steps.back().fitted.model, draft, draft.allowance(), watched);
    } catch (const Ended&) {
      result.stopped = true;
      return result;
    }
    const std::size_t kept = result.steps.size();
    for (const Finding* found :
         to_be_added(result.last, judge ? &*judge : nullptr, added_by(result.steps))) {
      const Finding& finding = *found;
      tell("adding " + finding.effect);
      const ImprovementStep& before = result.steps.back();
      extend.regions = finding.every_site ? kEverySite : kAutomaticRegions;
      ImprovementStep step =
          fitted_step(finding.effect, with_effect(before.fitted, finding.effect, fine, all, extend),
                      ground, folds, options);
      result.stopped = step.fitted.stopped;
      if (result.stopped) return result;
      const bool helps =
          step.fitted.converged && (few || remaining(before, step, finding, ground, folds) <=
                                               1 - options.diagnose.gates.held_out_fall);
      if (!helps) {
        result.refused = finding.effect;
        return result;
      }
      result.steps.push_back(std::move(step));
      if (few) result.steps.back().held_out = judge->error(added_by(result.steps));
    }
    if (result.steps.size() == kept) break;
    if (!few) continue;
    // What hides another may help only beside it: of few presses all that is missing is judged
    // together.
    const std::vector<ImprovementStep> smaller(
        result.steps.begin(), result.steps.begin() + static_cast<std::ptrdiff_t>(kept));
    if (judge->admits(judge->of(added_by(smaller), added_by(result.steps)))) continue;
    result.refused = refused_of(result.steps, kept);
    result.steps = smaller;
    return result;
  }
  return result;
}

}  // namespace hapsim
