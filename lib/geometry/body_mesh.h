// From a closed surface to a body of tetrahedra on its support.
#pragma once

#include <string>
#include <vector>

#include "geometry/support.h"
#include "geometry/tetmesh.h"

namespace hapsim {

struct BodyOptions {
  double edge = 0;        // wished edge length [m]; 0: from max_volume, else about 5000 tetrahedra
  double max_volume = 0;  // of one tetrahedron [m^3]; 0: none
  double radius_edge = 1.4;
  double min_dihedral = 0;        // [deg], wished, up to 18
  bool preserve_surface = false;  // keep the surface's triangles as they are
  int order = 1;
  Support support;
  std::vector<Vec3> contacts;  // refined about these points ...
  double tool_radius = 0;      // ... to half this radius
};

// The surface is coarsened where it is finer than wished (its volume kept, the outline of the
// bonded part kept) and split where it is coarser. Error(kBadInput) beginning with `where`: the
// surface is not closed, cuts itself, or no face of it is bonded where the support says so.
TetMesh make_body_mesh(const Surface& surface, const BodyOptions& options,
                       const std::string& where = "");

}  // namespace hapsim
