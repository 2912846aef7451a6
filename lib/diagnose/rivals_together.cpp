#include "diagnose/rivals_together.h"

#include <algorithm>
#include <cmath>

namespace hapsim {

bool both_act(const Candidate& a, const Candidate& b, Workspace& w) {
  constexpr double kPlainlyMore = 1.25;  // error of either alone over that of both
  const Eigen::VectorXd f = measured_forces(w.dataset, all_episodes(w.dataset));
  const double least =
      std::hypot(w.noise.value, w.floor * f.norm() / std::sqrt(static_cast<double>(f.size())));
  const double alone = std::min(a.fitted.rmse, b.fitted.rmse);
  if (alone < kPlainlyMore * w.noise.value) return false;
  std::string lack;
  std::optional<Candidate> both =
      try_effect(*b.effect, make_baseline(a.fitted.model, w, {}), w, lack);
  if (!both) return false;
  const EffectCard& card = b.effect->card();
  if (card.solved || card.from_locations) refine(*both, w);
  return both->fitted.rmse < kLikeNoise * least && both->fitted.rmse * kPlainlyMore < alone;
}

}  // namespace hapsim
