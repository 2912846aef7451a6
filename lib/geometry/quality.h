// How well shaped the tetrahedra of a mesh are.
#pragma once

#include <cstddef>

#include "geometry/tetmesh.h"

namespace hapsim {

struct Spread {
  double minimum = 0, median = 0, maximum = 0;
};

// Of the corners; straight edges. A regular tetrahedron has radius-edge 0.61 and dihedral 70.5 deg.
struct TetQuality {
  double volume = 0;             // [m^3]
  std::size_t inverted = 0;      // tetrahedra without positive volume
  Spread radius_edge;            // circumradius over shortest edge; inverted ones left out
  Spread smallest_dihedral_deg;  // the smallest of each tetrahedron's six
  double largest_dihedral_deg = 0;
  std::size_t worst = 0;  // tetrahedron of the smallest dihedral angle, or an inverted one
  Vec3 worst_place = Vec3::Zero();  // its centre
};
TetQuality tet_quality(const TetMesh& mesh);

// Circumradius over shortest edge of one tetrahedron.
double radius_edge_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace hapsim
