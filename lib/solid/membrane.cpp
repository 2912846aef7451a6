#include "solid/membrane.h"

#include "solid/face_quadrature.h"

namespace hapsim {

std::vector<MembraneFace> membrane_faces(const TetMesh& mesh, const std::vector<Triangle>& faces) {
  std::vector<MembraneFace> result;
  for (const std::vector<int>& nodes : face_nodes(mesh, faces)) {
    const auto size = static_cast<Eigen::Index>(nodes.size());
    MembraneFace face{nodes, Eigen::MatrixXd::Zero(3 * size, 3 * size)};
    for (const FacePoint& p : face_points(mesh, nodes)) {
      const double area = p.area.norm();
      const Eigen::Matrix3d across = p.area * p.area.transpose() / area;  // n n' dA
      for (Eigen::Index a = 0; a < size; ++a)
        for (Eigen::Index b = 0; b < size; ++b)
          face.matrix.block<3, 3>(3 * a, 3 * b) +=
              p.gradient[static_cast<std::size_t>(a)].dot(p.gradient[static_cast<std::size_t>(b)]) *
              across;
    }
    result.push_back(std::move(face));
  }
  return result;
}

std::vector<MembraneFace> free_membrane(const TetMesh& mesh) {
  std::vector<Triangle> faces;
  for (const Triangle& f : boundary_faces(mesh))
    if (!mesh.fixed[f[0]] || !mesh.fixed[f[1]] || !mesh.fixed[f[2]]) faces.push_back(f);
  return membrane_faces(mesh, faces);
}

}  // namespace hapsim
