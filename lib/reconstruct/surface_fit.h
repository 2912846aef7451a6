// Moves the vertices of a surface so that it runs through points in the least-squares sense.
#pragma once

#include <limits>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct SurfaceFitOptions {
  int rounds = 4;
  double smoothing = 0.1;  // weight of the displacement's Laplacian against the points
  double base = std::numeric_limits<double>::quiet_NaN();  // flat bottom: its vertices stay in it
};

// Each round: the distance of every point from its nearest triangle, weighted down when it is far
// off (Tukey, with the scale of the median), is made small by moving vertices along their normals
// (those of the bottom's rim within the plane), the second differences of the movement being kept
// small. No triangle turns over; a movement that would do so is halved.
void fit_surface(Surface& surface, const std::vector<Vec3>& points,
                 const SurfaceFitOptions& options);

}  // namespace hapsim
