#include "diagnose/rivals_together.h"

#include <algorithm>
#include <cmath>

namespace hapsim {

bool both_act(const Candidate& a, const Candidate& b, const TrialGround& g) {
  constexpr double kPlainlyMore = 1.25;  // error of either alone over that of both
  const double alone = std::min(a.fitted.error.pooled, b.fitted.error.pooled);
  if (alone < kPlainlyMore * g.allowance.noise) return false;
  std::string lack;
  std::optional<Candidate> both =
      try_effect(*b.effect, make_baseline(a.fitted.model, g, {}), g, lack);
  if (!both) return false;
  const EffectCard& card = b.effect->card();
  if (card.solved || card.is_map) refine(*both, g);
  return both->fitted.error.pooled < kLikeNoise * g.allowed_error() &&
         both->fitted.error.pooled * kPlainlyMore < alone;
}

}  // namespace hapsim
