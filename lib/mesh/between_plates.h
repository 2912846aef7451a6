// Bodies that are compressed between plates: the tool covers all of them.
#pragma once

#include "mesh/surface.h"

namespace hapsim {

// How far the body reaches below a flat tool [m]: a disc of `radius` [m] at `contact`, across the
// outward `normal`, when it covers the whole body; else 0. A rim of a fiftieth counts as covered.
double height_between_plates(const Surface& body, const Vec3& contact, const Vec3& normal,
                             double radius);

}  // namespace hapsim
