// How well shaped the tetrahedra of a mesh are.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

struct Spread {
  double minimum = 0, median = 0, maximum = 0;
};

// Counts between edges: count[i] in [edge[i], edge[i + 1]), the last without end.
struct Histogram {
  std::vector<double> edge;
  std::vector<std::size_t> count;
};

struct BadTet {
  std::size_t tet = 0;
  Vec3 place = Vec3::Zero();  // its centre [m]
  double radius_edge = 0, smallest_dihedral_deg = 0, aspect = 0;
};

// Of the corners; straight edges. A regular tetrahedron has radius-edge 0.61, dihedral angles of
// 70.5 deg and aspect 1.
struct TetQuality {
  double volume = 0;             // [m^3]
  std::size_t inverted = 0;      // tetrahedra without positive volume
  Spread radius_edge;            // circumradius over shortest edge; inverted ones left out
  Spread smallest_dihedral_deg;  // the smallest of each tetrahedron's six
  Spread aspect;                 // longest edge over inscribed radius, over 2 sqrt 6
  Spread edge;                   // of all tetrahedra [m]
  double largest_dihedral_deg = 0;
  Histogram radius_edge_counts, dihedral_counts, aspect_counts;
  std::vector<BadTet> worst_tets;  // ten of the smallest dihedral angles, worst first
  std::size_t worst = 0;           // tetrahedron of the smallest dihedral angle, or an inverted one
  Vec3 worst_place = Vec3::Zero();  // its centre
};
TetQuality tet_quality(const TetMesh& mesh);

// Circumradius over shortest edge of one tetrahedron.
double radius_edge_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace hapsim
