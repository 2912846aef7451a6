// Where points of a body's surface lie in the boundary elements of a contact mesh.
#pragma once

#include <array>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// A field at the point is the sum of weight times its values at the nodes.
struct SurfacePlace {
  std::array<int, 6> node;       // of a face: corners, then middles of edges 01, 12, 20
  std::array<double, 6> weight;  // second-order shape functions
};

// On the faces nearest to the points; the map of a face whose middles lie off the middles of its
// edges (the rim's quarter points) is inverted. `mesh`: of second order.
std::vector<SurfacePlace> surface_places(const TetMesh& mesh, const std::vector<Vec3>& points);

}  // namespace hapsim
