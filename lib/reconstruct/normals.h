// Normals of scanned points: estimated from neighbours and turned outward.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct NormalsReport {
  int neighbours = 0;  // points in each fit: more, the noisier the scan
  double noise = 0;    // median distance of points from the plane of their neighbours [m]
  int pieces = 0;      // parts of the scan too far apart to pass orientation on
};

// Unit normals by the plane of the k nearest points, k doubled from 12 until the points look flat
// (thickness below an eighth of the width); turned alike along the minimum spanning tree of the
// neighbour graph with weight 1 - |n.n'| (Hoppe et al. 1992), each piece then outward: away from
// the centre of the points and, where that does not decide (a patch seen from one side), towards
// `up`.
void estimate_normals(PointCloud& cloud, const Vec3& up, NormalsReport& report);

// Edge-preserving smoothing: each normal becomes the mean of its neighbours' within `radius` [m],
// weighted down by distance and by the angle between them (scale `angle_deg`), `rounds` times.
void sharpen_normals(PointCloud& cloud, double radius, double angle_deg, int rounds);

}  // namespace hapsim
