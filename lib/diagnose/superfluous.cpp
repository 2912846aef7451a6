#include "diagnose/superfluous.h"

#include <cmath>

#include "diagnose/measure.h"
#include "effects/catalogue.h"
#include "model/model_edit.h"

namespace hapsim {

std::optional<Baseline> without_superfluous(const std::string& effect, const Baseline& base,
                                            const TrialGround& g, const Folds& folds,
                                            const Gates& gates) {
  // A model that errs so much more lacks it; only the others are worth the refits of the folds.
  constexpr double kPlainlyMore = 1.1;
  Model lesser = base.fitted.model;
  remove_effect(lesser, effect);
  Baseline without = make_baseline(lesser, g, {});
  if (!without.fitted.converged ||
      without.fitted.error.pooled > kPlainlyMore * base.fitted.error.pooled)
    return std::nullopt;
  without = make_baseline(without.fitted.model, g, folds);
  Candidate candidate;
  candidate.effect = &require_effect(effect);
  candidate.fitted = base.fitted;
  candidate.held_out = held_out_for(*candidate.effect, base);
  const Yardstick yardstick = make_yardstick(without, {candidate}, g);
  const double gain = measure(candidate, without, yardstick, g).criterion_gain;
  const double noise = g.allowance.noise * g.allowance.noise;
  const double more = without.fitted.error.pooled * without.fitted.error.pooled;
  const double fall = more - base.fitted.error.pooled * base.fitted.error.pooled;
  const double share = more > 1.01 * noise ? fall / (more - noise) : 0;
  const bool helps_unseen =
      folds.held_out.empty() ||
      held_out_for(*candidate.effect, base).error.pooled <
          (1 - gates.held_out_fall) * held_out_for(*candidate.effect, without).error.pooled;
  if (gain > gates.criterion_gain && share >= gates.share && helps_unseen) return std::nullopt;
  return without;
}

}  // namespace hapsim
