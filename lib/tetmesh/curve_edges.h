// Second-order bodies whose boundary follows a smooth surface.
#pragma once

#include "mesh/tetmesh.h"

namespace hapsim {

struct CurvedEdges {
  std::size_t moved = 0;     // boundary nodes laid on the surface
  std::size_t straight = 0;  // boundary nodes left where they were, for a tetrahedron would fold
  double farthest = 0;       // largest move [m]
};

// Lays the boundary nodes of an order 2 mesh, corners and middles, on the nearest point of
// `smooth`, within a quarter of the edge; fixed nodes stay. Where the Jacobian of a tetrahedron's
// quadratic map would fall below a tenth of the straight one's at a corner, a middle or the centre,
// its nodes are put back.
CurvedEdges curve_edges(TetMesh& mesh, const Surface& smooth);

}  // namespace hapsim
