// How far apart places lie.
#pragma once

#include <vector>

#include "base/vec3.h"

namespace hapsim {

// Median distance to the nearest neighbour [m], of an even number the upper; not finite of one
// place.
double spacing_of(const std::vector<Vec3>& places);

}  // namespace hapsim
