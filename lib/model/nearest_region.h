// Which region of an inhomogeneous material a point belongs to.
#pragma once

#include <limits>

#include "effects/effect.h"

namespace hapsim {

// That of its nearest key point, in plan view; 0 without key points.
inline int region_at(const MaterialSpec& material, const Vec3& p) {
  int region = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < material.key_point.size(); ++k) {
    const double distance = (material.key_point[k] - p).head<2>().squaredNorm();
    if (distance < least) least = distance, region = material.key_region[k];
  }
  return region;
}

}  // namespace hapsim
