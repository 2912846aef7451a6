#include "diagnose/superfluous.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "effects/catalogue.h"

namespace hapsim {

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
  constexpr double kPlainlyMore = 1.1;
  return !fitted.converged || fitted.error.pooled > kPlainlyMore * base.fitted.error.pooled;
}

std::optional<Baseline> without_superfluous(const std::string& effect, const Baseline& base,
                                            const TrialGround& g, const Folds& folds,
                                            const Gates& gates) {
  Baseline without = without_effect(effect, base, g, {});
  if (errs_plainly_more(without.fitted, base)) return std::nullopt;
  without = make_baseline(without.fitted.model, g, folds);
  if (is_needed(require_effect(effect), base, without, g, folds, gates)) return std::nullopt;
  return without;
}

}  // namespace hapsim
