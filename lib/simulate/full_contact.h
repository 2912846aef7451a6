// Where a tool meets a body's own mesh.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "mesh/tetmesh.h"

namespace hapsim {

struct FullContact {
  Vec3 point, normal;      // m; unit, outward, zero where every face there is held
  std::vector<int> nodes;  // under the flat tool, free ones
};

// Where a tool meets the body's own mesh: the boundary nodes within its radius about the nearest
// boundary node, on faces that look the same way.
FullContact full_contact(const TetMesh& mesh, const Vec3& at, double radius);

}  // namespace hapsim
