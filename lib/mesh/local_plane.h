// The plane that fits points about a place.
#pragma once

#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct LocalPlane {
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // unit, sign free
  double thickness = 0;         // rms distance of the points from the plane [m]
  Vec3 spread = Vec3::Zero();   // rms along the three principal axes, smallest first [m]
};

// Principal axes of the points; with `weights` (as many as points) weighted. At least one point.
LocalPlane fit_plane(const std::vector<Vec3>& points, const std::vector<double>& weights = {});

}  // namespace hapsim
