// A body as tetrahedra of first (4 nodes) or second order (10 nodes).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/held_bytes.h"
#include "base/vec3.h"
#include "mesh/surface.h"

namespace hapsim {

// Second-order node order (as VTK): corners 0-3, then the middles of the edges
// 4:(0,1) 5:(1,2) 6:(0,2) 7:(0,3) 8:(1,3) 9:(2,3). First order leaves 4..9 at -1.
inline constexpr int kTetEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

struct TetMesh {
  int order = 1;
  std::vector<Vec3> nodes;                // [m]
  std::vector<std::array<int, 10>> tets;  // positive volume
  std::vector<int> region;                // one a tetrahedron
  std::vector<std::uint8_t> fixed;        // one a node; 1: bonded to the support
  std::vector<Triangle> faces;            // boundary, corner nodes, outward
  std::size_t held_bytes() const {
    return hapsim::held_bytes(nodes) + hapsim::held_bytes(tets) + hapsim::held_bytes(region) +
           hapsim::held_bytes(fixed) + hapsim::held_bytes(faces);
  }
};

double tet_volume(const TetMesh& mesh, std::size_t tet);  // from the corners, signed [m^3]
// Below this a tetrahedron is flat to rounding [m^3]; real meshes stay orders of magnitude above.
double least_volume(const TetMesh& mesh, std::size_t tet);
Vec3 tet_centroid(const TetMesh& mesh, std::size_t tet);  // of the corners
double volume(const TetMesh& mesh);
// Adds the middles of all edges (straight): order 1 -> 2. A middle is fixed when its edge lies on a
// boundary face whose corners are all fixed.
TetMesh to_second_order(const TetMesh& mesh);
// The faces that belong to one tetrahedron only, outward, ordered by their sorted corners.
std::vector<Triangle> boundary_faces(const TetMesh& mesh);
// Boundary faces as a surface with compact vertices; `node` maps its vertices to mesh nodes.
Surface boundary_surface(const TetMesh& mesh, std::vector<int>* node = nullptr);

}  // namespace hapsim
