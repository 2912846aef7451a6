// Surface points that become vertices.
#pragma once

#include <vector>

#include "repair/coarsen.h"

namespace hapsim {

// Makes each point a vertex of the surface: the vertex beside it is moved there, or the triangle or
// edge nearest to it is divided. The points should lie on or next to the surface; where moving the
// surface there would fold it, the nearest point of the surface is taken; points closer than a
// tenth of the edges share a vertex. Returns the vertex numbers; the old vertices keep theirs.
// O(points x faces).
std::vector<int> insert_points(ClassedSurface& classed, const std::vector<Vec3>& points);

}  // namespace hapsim
