// The closed surface whose normals the points have.
#pragma once

#include <cstdint>

#include "mesh/surface.h"

namespace hapsim {

// Poisson reconstruction (Kazhdan, Bolitho, Hoppe 2006) over a Delaunay triangulation, meshed with
// triangles of about `cell` [m], by CGAL. Needs points with outward normals. May hold more than one
// part. Deterministic for a seed. Error(kNoConvergence) when the equations or the mesher fail.
Surface poisson_surface(const PointCloud& cloud, double cell, std::uint64_t seed);

}  // namespace hapsim
