#include "diagnose/superfluous.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "effects/catalogue.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

// A model that errs so much more lacks the effect; only others are worth the refits of the folds.
constexpr double kPlainlyMore = 1.1;

// Whether `effect` of `base` passes the gates beside `lesser`, which is held out with it.
bool is_needed(const Effect& effect, const Baseline& base, const Baseline& lesser,
               const TrialGround& g, const Folds& folds, const Gates& gates) {
  Candidate candidate;
  candidate.effect = &effect;
  candidate.fitted = base.fitted;
  candidate.held_out = held_out_for(effect, base);
  const Yardstick yardstick = make_yardstick(lesser, {candidate}, g);
  const double gain = measure(candidate, lesser, yardstick, g).criterion_gain;
  const double noise = g.allowance.noise * g.allowance.noise;
  const double more = lesser.fitted.error.pooled * lesser.fitted.error.pooled;
  const double fall = more - base.fitted.error.pooled * base.fitted.error.pooled;
  const double share = more > 1.01 * noise ? fall / (more - noise) : 0;
  const bool helps_unseen =
      folds.held_out.empty() ||
      candidate.held_out.error.pooled <
          (1 - gates.held_out_fall) * held_out_for(effect, lesser).error.pooled;
  return gain > gates.criterion_gain && share >= gates.share && helps_unseen;
}

bool errs_plainly_more(const Fit& fitted, const Baseline& base) {
  return !fitted.converged || fitted.error.pooled > kPlainlyMore * base.fitted.error.pooled;
}

}  // namespace

std::optional<Baseline> without_superfluous(const std::string& effect, const Baseline& base,
                                            const TrialGround& g, const Folds& folds,
                                            const Gates& gates) {
  Model lesser = base.fitted.model;
  remove_effect(lesser, effect);
  Baseline without = make_baseline(lesser, g, {});
  if (errs_plainly_more(without.fitted, base)) return std::nullopt;
  without = make_baseline(without.fitted.model, g, folds);
  if (is_needed(require_effect(effect), base, without, g, folds, gates)) return std::nullopt;
  return without;
}

std::optional<Simpler> simpler_in_place(const std::string& effect, const std::string& unknown,
                                        const Baseline& base, const TrialGround& g,
                                        const Folds& folds, const Gates& gates) {
  const EffectCard& card = require_effect(effect).card();
  if (card.is_map || card.is_field || card.contains.empty()) return std::nullopt;
  Model lesser = base.fitted.model;
  remove_effect(lesser, effect);
  const Baseline without = make_baseline(lesser, g, {});
  if (!without.fitted.converged) return std::nullopt;
  std::vector<std::string> simplest_first = card.contains;
  std::stable_sort(simplest_first.begin(), simplest_first.end(),
                   [](const std::string& a, const std::string& b) {
                     return require_effect(a).card().parameters.size() <
                            require_effect(b).card().parameters.size();
                   });
  for (const std::string& name : simplest_first) {
    if (name == unknown) continue;
    std::string lack;
    const std::optional<Candidate> candidate = try_effect(require_effect(name), without, g, lack);
    if (!candidate || errs_plainly_more(candidate->fitted, base)) continue;
    Baseline with = make_baseline(candidate->fitted.model, g, folds);
    if (is_needed(require_effect(effect), base, with, g, folds, gates)) continue;
    Simpler simpler{*candidate, {}, std::move(with)};
    simpler.candidate.held_out = held_out_for(*candidate->effect, simpler.base);
    simpler.measured =
        measure(simpler.candidate, without, make_yardstick(without, {simpler.candidate}, g), g);
    return simpler;
  }
  return std::nullopt;
}

}  // namespace hapsim
