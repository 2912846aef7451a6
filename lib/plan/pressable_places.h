// Where a tool can be pressed onto a body that is known by its surface alone.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct PressablePlace {
  Vec3 point, normal;  // on the surface; outward unit normal of its face
};

// At most some hundreds, evenly over the part of the surface whose normals are within `steepest`
// [rad] of +z, about a tool's radius apart, and none at an edge: all around, 1.3 radii away, the
// surface goes on and looks about the same way. By the shape alone: whether the tool's disc can be
// meshed there is found out where it is pressed.
std::vector<PressablePlace> pressable_places(const Surface& surface, double tool_radius,
                                             double steepest);

}  // namespace hapsim
