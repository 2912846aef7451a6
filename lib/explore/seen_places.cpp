#include "explore/seen_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imaging/stiffness_image.h"

namespace hapsim {

std::vector<SeenPlace> seen_places(const Fit& fitted, const Experiment& experiment) {
  constexpr double kUseless = 0.3;  // relative error from which on a logarithm says nothing
  const std::size_t n = experiment.dataset.positions.size();
  std::vector<double> weight(n, 0), sum(n, 0);
  for (const ImageView& v : image_views(fitted.model, experiment, fitted.about)) {
    if (!(v.error <= kUseless * v.gain)) continue;
    const double own = v.gain / v.error;
    weight[static_cast<std::size_t>(v.position)] += own * own;
    sum[static_cast<std::size_t>(v.position)] += own * own * std::log(v.gain);
  }
  std::vector<SeenPlace> seen;
  for (std::size_t p = 0; p < n; ++p)
    seen.push_back({experiment.dataset.positions[p],
                    weight[p] > 0 ? sum[p] / weight[p] : std::numeric_limits<double>::quiet_NaN()});
  return seen;
}

std::vector<SeenPlace> pressed_places(const Recording& recording) {
  std::vector<SeenPlace> seen;
  for (const Press& press : recording.presses()) {
    const Vec3& p = recording.position[static_cast<std::size_t>(press.rows.front())];
    if (std::none_of(seen.begin(), seen.end(),
                     [&](const SeenPlace& s) { return (s.point - p).norm() <= kSamePlace; }))
      seen.push_back({p, std::numeric_limits<double>::quiet_NaN()});
  }
  return seen;
}

}  // namespace hapsim
