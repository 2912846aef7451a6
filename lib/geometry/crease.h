// Sharp edges, which a smooth reconstruction rounds, back into a surface.
#pragma once

#include <limits>

#include "geometry/surface.h"

namespace hapsim {

struct CreaseOptions {
  double edge = 0;                                         // edge length of the surface [m]
  double spacing = 0;                                      // distance of neighbouring points [m]
  double base = std::numeric_limits<double>::quiet_NaN();  // flat bottom: its rim stays in it
};

// Moves vertices beside a sharp edge or corner onto it: where the points about a vertex fall into
// two or three groups of normals 45 degrees apart, the vertex goes to where the groups' planes meet
// (the quadratic error function of Garland and Heckbert 1997), the nearest vertices first, none so
// that two meet; edges that still cross the crease between two moved vertices are flipped onto it.
// Returns the number of moved vertices.
int snap_to_creases(Surface& surface, const PointCloud& cloud, const CreaseOptions& options);

}  // namespace hapsim
