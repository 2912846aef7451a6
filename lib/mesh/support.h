// Which part of a body is bonded to its support.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

enum class SupportKind {
  kBottom,  // the faces that lie flat on the lowest plane z = min
  kPlane,   // the faces on the plane normal . x = z
  kBelow,   // the faces below the height z
  kNone,
  kBox,     // the faces within a box
  kPoints,  // the nodes nearest to given points
  kNodes,   // nodes by number
};

struct Support {
  SupportKind kind = SupportKind::kBottom;
  double z = 0;                 // [m]
  double tolerance = 0;         // of kBottom and kPlane [m]; 0: 0.5 % of the body's height
  Vec3 normal = Vec3::UnitZ();  // of kPlane, unit
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // of kBox [m]
  std::vector<Vec3> points = {};                 // of kPoints [m]
  std::vector<int> nodes = {};                   // of kNodes, from 0
  std::vector<Support> also = {};                // what these bond is bonded too
};

// "bottom", "plane:0.01" (height), "plane:nx,ny,nz,h" (the plane n . x = h), "below:0.01",
// "box:x0,y0,z0,x1,y1,z1", "file:PATH" [m] or "none"; several joined by "+". A file is a CSV with
// the columns x,y,z (each fixes its nearest boundary node) or `node` (numbers from 0).
// Error(kUsage) otherwise; Error(kBadInput) for a bad file.
Support parse_support(const std::string& text);

// Whether any part of it is a region of the surface (not kNone, kPoints, kNodes).
bool bonds_faces(const Support& support);

// One a face: 1 when all its corners are bonded.
std::vector<std::uint8_t> bonded_faces(const std::vector<Vec3>& nodes,
                                       const std::vector<Triangle>& faces, const Support& support);

// Sets mesh.fixed anew for all nodes, middles too, of the boundary faces with bonded[face]; returns
// how many are fixed.
int fix_faces(TetMesh& mesh, const std::vector<std::uint8_t>& bonded);

// Fixes the nodes that kPoints and kNodes name, besides those that are fixed. Error(kBadInput)
// beginning with `where`: a point lies farther off the body than its longest boundary edge, a
// number is out of range.
void fix_named_nodes(TetMesh& mesh, const Support& support, const std::string& where);

// All nodes, corners and middles, of the boundary faces with chosen[face], in order.
std::vector<int> nodes_of_faces(const TetMesh& mesh, const std::vector<std::uint8_t>& chosen);

// Fixes a body's bottom: fix_faces of bonded_faces.
int fix_bottom(TetMesh& mesh);

}  // namespace hapsim
