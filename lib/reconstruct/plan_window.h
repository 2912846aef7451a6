// The outline of a body that goes on beyond the points of its scan.
#pragma once

#include "reconstruct/plan_view.h"

namespace hapsim {

// As plan_outline(), at a distance of `beyond` [m] outside the points' own outline.
std::vector<Vec2> outline_beyond(const std::vector<Vec3>& points, double reach, double edge,
                                 double beyond);

}  // namespace hapsim
