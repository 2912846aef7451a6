// What lies between places where something was seen.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

inline constexpr double kSeenApart = 1e-3;  // places nearer than this are one [m]

// Values seen at places, interpolated by the inverse cubes of the distances (Shepard, 1968);
// `nothing` where none was seen, or none but number `without`.
template <typename Value>
Value inverse_cubes(const std::vector<std::pair<Vec3, Value>>& seen, const Value& nothing,
                    const Vec3& place, std::size_t without = static_cast<std::size_t>(-1)) {
  Value sum = nothing;
  double weights = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (i == without) continue;
    const double squared = (seen[i].first - place).squaredNorm() + kSeenApart * kSeenApart;
    const double weight = 1 / (squared * std::sqrt(squared));
    sum += weight * seen[i].second;
    weights += weight;
  }
  return weights > 0 ? Value(sum / weights) : nothing;
}

}  // namespace hapsim
