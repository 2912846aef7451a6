// Where a recording presses.
#pragma once

#include <vector>

#include "recording/recording.h"

namespace hapsim {

// Distinct contact points [m], by x, then y, then z.
std::vector<Vec3> contact_points(const Recording& recording);

}  // namespace hapsim
