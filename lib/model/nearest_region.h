// Which region of an inhomogeneous material a point belongs to.
#pragma once

#include <limits>
#include <utility>
#include <vector>

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

// The modulus that a contact feels by itself (MaterialSpec::local).
struct LocalModulus {
  double value = 0;                           // [Pa]
  std::vector<std::pair<int, double>> share;  // region, and its share of log E; sums to 1
};
// The moduli of the nearest key points, in plan view: their logarithms weighted by inverse squared
// distances that fade out (Franke and Little's form of Shepard's interpolation, 1968; Franke, Math.
// Comp. 38, 1982). At a key point it is that one's own.
LocalModulus local_modulus(const MaterialSpec& material, const Vec3& p);

}  // namespace hapsim
