// The closed surface whose normals the points have.
#pragma once

#include <cstdint>

#include "mesh/surface.h"

namespace hapsim {

// Poisson reconstruction (Kazhdan, Bolitho, Hoppe 2006) by CGAL over a Delaunay triangulation, with
// triangles of about `cell`, at most `off` off it [m]. Needs outward normals. May hold more than
// one part. Deterministic for a seed. Error(kNoConvergence) when the equations or the mesher fail.
Surface poisson_surface(const PointCloud& cloud, double cell, double off, std::uint64_t seed);

}  // namespace hapsim
