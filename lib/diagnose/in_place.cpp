#include "diagnose/in_place.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "diagnose/held_out.h"
#include "diagnose/superfluous.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

std::optional<Candidate> tried(const std::string& name, const Baseline& without,
                               const Baseline& base, const TrialGround& g) {
  std::string lack;
  std::optional<Candidate> candidate = try_effect(require_effect(name), without, g, lack);
  if (candidate && errs_plainly_more(candidate->fitted, base)) candidate.reset();
  return candidate;
}

InPlace in_place(Candidate candidate, const Baseline& without, Baseline with,
                 const TrialGround& g) {
  InPlace found{std::move(candidate), {}, std::move(with)};
  found.candidate.held_out = held_out_for(*found.candidate.effect, found.base);
  found.measured =
      measure(found.candidate, without, make_yardstick(without, {found.candidate}, g), g);
  return found;
}

// The curves over the same thing.
std::vector<std::string> curves_over(const std::string& effect, const Model& model) {
  std::vector<std::string> curves;
  for (const Effect* e : catalogue()) {
    const EffectCard& card = e->card();
    if (card.learned && !card.is_field && !model.has(card.name) &&
        (std::count(card.confounders.begin(), card.confounders.end(), effect) > 0 ||
         contains(*e, effect)))
      curves.push_back(card.name);
  }
  return curves;
}

}  // namespace

std::optional<InPlace> simpler_in_place(const std::string& effect, const std::string& unknown,
                                        const Baseline& base, const TrialGround& g,
                                        const Folds& folds, const Gates& gates) {
  const EffectCard& card = require_effect(effect).card();
  if (card.is_map || card.is_field || card.contains.empty()) return std::nullopt;
  const Baseline without = without_effect(effect, base, g, {});
  if (!without.fitted.converged) return std::nullopt;
  std::vector<std::string> simplest_first = card.contains;
  std::stable_sort(simplest_first.begin(), simplest_first.end(),
                   [](const std::string& a, const std::string& b) {
                     return require_effect(a).card().parameters.size() <
                            require_effect(b).card().parameters.size();
                   });
  for (const std::string& name : simplest_first) {
    if (name == unknown) continue;
    std::optional<Candidate> candidate = tried(name, without, base, g);
    if (!candidate) continue;
    Baseline with = make_baseline(candidate->fitted.model, g, folds);
    if (!is_needed(require_effect(effect), base, with, g, folds, gates))
      return in_place(std::move(*candidate), without, std::move(with), g);
  }
  return std::nullopt;
}

std::optional<InPlace> curve_in_place(const std::string& effect, const std::string& left,
                                      const std::string& unknown, const Baseline& base,
                                      const TrialGround& g, const Folds& folds,
                                      const Gates& gates) {
  const EffectCard& card = require_effect(effect).card();
  if (card.is_map || card.is_field || card.learned || folds.held_out.empty()) return std::nullopt;
  const std::vector<std::string> curves = curves_over(effect, base.fitted.model);
  if (curves.empty()) return std::nullopt;
  const Baseline without = without_effect(effect, base, g, {});
  if (!without.fitted.converged) return std::nullopt;
  std::optional<InPlace> best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::string& name : curves) {
    if (name == unknown) continue;
    std::optional<Candidate> candidate = tried(name, without, base, g);
    if (!candidate) continue;
    Baseline with = make_baseline(candidate->fitted.model, g, folds);
    const double unseen = held_out_for(*candidate->effect, with).error.pooled;
    const std::vector<std::string>& kinds = candidate->effect->card().kinds;
    const double fall = std::count(kinds.begin(), kinds.end(), left) > 0 ? 0 : gates.held_out_fall;
    if (unseen >= std::min(least, (1 - fall) * base.on_known_map.error.pooled)) continue;
    least = unseen;
    best = in_place(std::move(*candidate), without, std::move(with), g);
  }
  return best;
}

void describe_in_place(const InPlace& found, const Dataset& dataset, Finding& f) {
  f.effect = found.candidate.effect->card().name;
  f.criterion_gain = found.measured.criterion_gain;
  f.memory = found.measured.memory;
  f.where = describe_where(found.candidate);
  f.next_measurement = found.candidate.effect->card().separated_by;
  f.values.clear();
  f.smallest = Finding{}.smallest;
  describe_fit(found.candidate, found.measured, dataset, f);
}

}  // namespace hapsim
