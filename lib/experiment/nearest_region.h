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
// Of the nearest key points, in plan view: a plane through their log E, weighted by inverse squared
// distances that fade out (moving least squares: Lancaster and Salkauskas, Math. Comp. 37, 1981;
// weights: Franke and Nielson, 1980), its slope held back a little. At a key point it is that one's
// own; a gradual change is gone on with a little beyond them.
LocalModulus local_modulus(const MaterialSpec& material, const Vec3& p);

}  // namespace hapsim
