#include "solid/foundation.h"

#include <Eigen/Geometry>

#include "base/error.h"
#include "solid/face_quadrature.h"

namespace hapsim {
std::vector<FoundationFace> foundation_faces(const TetMesh& mesh, const Foundation& foundation) {
  if (!(foundation.normal >= 0 && foundation.tangential >= 0))
    fail_input("", "a foundation stiffness is negative", "give k >= 0 [Pa/m]");
  std::vector<FoundationFace> faces;
  for (const std::vector<int>& nodes : face_nodes(mesh, foundation.faces)) {
    const Eigen::Index size = static_cast<Eigen::Index>(nodes.size());
    FoundationFace face{nodes, Eigen::MatrixXd::Zero(3 * size, 3 * size), {}};
    face.by_tangential = face.by_normal;
    for (const FacePoint& p : face_points(mesh, nodes)) {
      const double area = p.area.norm();
      const Vec3 n = p.area / area;
      const Eigen::Matrix3d along = n * n.transpose();
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
      for (Eigen::Index a = 0; a < size; ++a)
        for (Eigen::Index b = 0; b < size; ++b) {
          const double share = area * p.shape[a] * p.shape[b];
          face.by_normal.block<3, 3>(3 * a, 3 * b) += share * along;
          face.by_tangential.block<3, 3>(3 * a, 3 * b) += share * across;
        }
    }
    faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace hapsim
