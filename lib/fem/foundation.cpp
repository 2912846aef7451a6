#include "fem/foundation.h"

#include <Eigen/Geometry>

#include "base/error.h"
#include "fem/surface_load.h"

namespace hapsim {
namespace {

// Integral of N_a N_b over a triangle of unit area: Zienkiewicz and Taylor, vol. 1, for three
// corners and for corners with the middles 01, 12, 20.
Eigen::MatrixXd unit_mass(int order) {
  if (order == 1) return (Eigen::Matrix3d::Ones() + Eigen::Matrix3d::Identity()) / 12;
  Eigen::MatrixXd m(6, 6);
  m << 6, -1, -1, 0, -4, 0,  //
      -1, 6, -1, 0, 0, -4,   //
      -1, -1, 6, -4, 0, 0,   //
      0, 0, -4, 32, 16, 16,  //
      -4, 0, 0, 16, 32, 16,  //
      0, -4, 0, 16, 16, 32;
  return m / 180;
}

}  // namespace

std::vector<FoundationFace> foundation_faces(const TetMesh& mesh, const Foundation& foundation) {
  if (!(foundation.normal >= 0 && foundation.tangential >= 0))
    fail_input("", "a foundation stiffness is negative", "give k >= 0 [Pa/m]");
  const Eigen::MatrixXd mass = unit_mass(mesh.order);
  std::vector<FoundationFace> faces;
  for (const std::vector<int>& f : face_nodes(mesh, foundation.faces)) {
    FoundationFace face;
    face.nodes = f;
    const Vec3 cross =
        (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]);
    const double area = cross.norm() / 2;
    const Vec3 n = cross.normalized();
    const Eigen::Matrix3d along = n * n.transpose();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
    const Eigen::Index size = mass.rows();
    face.by_normal.resize(3 * size, 3 * size);
    face.by_tangential.resize(3 * size, 3 * size);
    for (Eigen::Index a = 0; a < size; ++a)
      for (Eigen::Index b = 0; b < size; ++b) {
        face.by_normal.block<3, 3>(3 * a, 3 * b) = area * mass(a, b) * along;
        face.by_tangential.block<3, 3>(3 * a, 3 * b) = area * mass(a, b) * across;
      }
    faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace hapsim
