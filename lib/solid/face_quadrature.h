// Integration over boundary faces, curved ones included.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// The nodes of a boundary face: its corners a, b, c and, of second order, the middles of ab, bc,
// ca. Error(kBadInput) when a face has an edge that no tetrahedron has.
std::vector<std::vector<int>> face_nodes(const TetMesh& mesh, const std::vector<Triangle>& faces);

struct FacePoint {
  std::array<double, 3> corner;  // barycentric: the linear hats of the corners
  std::array<double, 6> shape;   // N of the face's 3 or 6 nodes
  std::array<Vec3, 6> gradient;  // of N along the face [1/m]
  Vec3 position;                 // [m]
  Vec3 area;                     // outward normal times the point's share of the area [m^2]
};
// Seven points of degree 5 (Radon, 1948), isoparametric.
std::array<FacePoint, 7> face_points(const TetMesh& mesh, const std::vector<int>& nodes);

}  // namespace hapsim
