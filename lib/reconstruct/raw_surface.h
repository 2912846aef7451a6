// Triangles over points, by several methods. What they give need not be closed or manifold: it
// passes through repair_surface() and is made even and fitted afterwards. All are deterministic.
// Error(kBadInput) when the points span no volume, Error(kNoConvergence) when nothing comes out.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Power crust (Amenta, Choi, Kolluri 2001): the poles, the farthest corners of each point's Voronoi
// cell on either side, with the balls about them that reach to the point; each is inside or outside
// by the normals of its points, outside beside a box far about; the faces of the power diagram
// between inner and outer balls are the surface. Balls smaller than `least_radius` [m], which noise
// makes, are left out. Needs outward normals.
Surface power_crust(const PointCloud& cloud, double least_radius);

// Restricted Delaunay triangulation: every tetrahedron of the Delaunay triangulation is inside or
// outside, by the side of its corners' tangent planes on which its circumcentre lies (those near
// the surface by their neighbours); the triangles between are the surface. Closed by construction,
// its vertices are points. For nearly uniform samples with outward normals.
Surface restricted_delaunay(const PointCloud& cloud);

// Advancing front over the Delaunay triangulation (Cohen-Steiner, Da 2004): the vertices are
// points; gaps stay open.
Surface advancing_front(const std::vector<Vec3>& points);

}  // namespace hapsim
