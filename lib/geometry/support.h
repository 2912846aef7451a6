// Which part of a body is bonded to its support.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/tetmesh.h"

namespace hapsim {

enum class SupportKind {
  kBottom,  // the faces that lie flat on the lowest plane z = min
  kPlane,   // the faces on the plane at height z
  kBelow,   // the faces below the height z
  kNone,
};

struct Support {
  SupportKind kind = SupportKind::kBottom;
  double z = 0;          // [m]
  double tolerance = 0;  // of kBottom and kPlane [m]; 0: 0.5 % of the body's height
};

// "bottom", "plane:0.01", "below:0.01" [m] or "none". Error(kUsage) otherwise.
Support parse_support(const std::string& text);

// One a face: 1 when all its corners are bonded.
std::vector<std::uint8_t> bonded_faces(const std::vector<Vec3>& nodes,
                                       const std::vector<Triangle>& faces, const Support& support);

// Sets mesh.fixed anew for all nodes, middles too, of the boundary faces with bonded[face]; returns
// how many are fixed.
int fix_faces(TetMesh& mesh, const std::vector<std::uint8_t>& bonded);

// All nodes, corners and middles, of the boundary faces with chosen[face], in order.
std::vector<int> nodes_of_faces(const TetMesh& mesh, const std::vector<std::uint8_t>& chosen);

// Fixes a body's bottom: fix_faces of bonded_faces.
int fix_bottom(TetMesh& mesh);

}  // namespace hapsim
