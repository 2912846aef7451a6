#include "diagnose/shared_by_places.h"

#include <fmt/format.h>

#include "diagnose/held_out.h"
#include "diagnose/measure.h"
#include "effects/catalogue.h"
#include "fit/learned_field.h"

namespace hapsim {
namespace {

// The model without the effect, where places that are free do all that it does.
std::optional<Baseline> as_well_by_places(const Effect& effect, const Baseline& base,
                                          const TrialGround& g, const Folds& folds,
                                          const Gates& gates) {
  Baseline without = without_effect(effect.card().name, base, g, folds);
  if (!without.fitted.converged) return std::nullopt;
  Candidate candidate;
  candidate.effect = &effect;
  candidate.fitted = base.fitted;
  const Measured m = measure(candidate, without, make_yardstick(without, {candidate}, g, true), g);
  if (!m.hidden && m.criterion_gain > gates.criterion_gain) return std::nullopt;
  return without;
}

// What is left does, or it is left beside places that are known to.
bool places_differ(const Fit& fitted, const TrialGround& g) {
  if (learns_field(fitted.model)) return false;
  LeftOver left = left_over(fitted, g);
  tell_kinds(fitted, g, left);
  return left.kind == kBody || (has_map(fitted.model) && !left.noise_alone());
}

}  // namespace

bool doubt_what_places_share(Baseline& base, const TrialGround& g, const Folds& folds,
                             const Gates& gates, std::vector<Finding>& findings) {
  if (!places_differ(base.fitted, g)) return false;
  bool any = false;
  for (auto f = findings.rbegin(); f != findings.rend(); ++f) {
    if (f->verdict != Verdict::kMissing) continue;
    const Effect& effect = require_effect(f->effect);
    if (effect.card().stage != Stage::kSensor || !base.fitted.model.has(f->effect)) continue;
    auto without = as_well_by_places(effect, base, g, folds, gates);
    if (!without) continue;
    base = std::move(*without);
    f->verdict = Verdict::kPossible;
    f->evidence += "; a stiffness and a law of the depth of each place's own would do the same";
    f->next_measurement = fmt::format("{} places or more, to learn how they differ; {}",
                                      kLeastPlaces, f->next_measurement);
    any = true;
  }
  return any;
}

}  // namespace hapsim
