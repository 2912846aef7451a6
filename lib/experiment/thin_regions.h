// Regions of a body that meshes of contacts may miss.
#pragma once

#include <utility>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// Numbers other than 0 of tetrahedra that make a sheet, and how thick [m]: twice the volume over
// the area of what bounds it, less than a seventh of the cube root of the volume (a ball: 0.41).
std::vector<std::pair<int, double>> thin_regions(const TetMesh& body);

}  // namespace hapsim
