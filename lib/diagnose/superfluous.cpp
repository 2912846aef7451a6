#include "diagnose/superfluous.h"

#include <cmath>

#include "effects/catalogue.h"
#include "model/model_edit.h"

namespace hapsim {

std::optional<Baseline> without_superfluous(const std::string& effect, const Baseline& base,
                                            Workspace& w, const Folds& folds, const Gates& gates) {
  // A model that errs so much more lacks it; only the others are worth the refits of the folds.
  constexpr double kPlainlyMore = 1.1;
  Model lesser = base.fitted.model;
  remove_effect(lesser, effect);
  Baseline without = make_baseline(lesser, w, {});
  if (!without.fitted.converged || without.fitted.rmse > kPlainlyMore * base.fitted.rmse)
    return std::nullopt;
  without = make_baseline(without.fitted.model, w, folds);
  Candidate candidate;
  candidate.effect = &require_effect(effect);
  candidate.fitted = base.fitted;
  const Yardstick yardstick = make_yardstick(without, {candidate}, w);
  const Measured m = measure(candidate, without, yardstick, w);
  const double gain = yardstick.residual.squaredNorm() - m.sum_of_squares - m.penalty;
  const double noise = w.noise.value * w.noise.value;
  const double more = without.fitted.rmse * without.fitted.rmse;
  const double fall = more - base.fitted.rmse * base.fitted.rmse;
  const double share = more > 1.01 * noise ? fall / (more - noise) : 0;
  const bool helps_unseen =
      folds.held_out.empty() ||
      held_out_for(*candidate.effect, base).rmse <
          (1 - gates.held_out_fall) * held_out_for(*candidate.effect, without).rmse;
  if (gain > gates.criterion_gain && share >= gates.share && helps_unseen) return std::nullopt;
  return without;
}

}  // namespace hapsim
