#include "solid/surface_load.h"

#include "solid/face_quadrature.h"

namespace hapsim {
namespace {

// `force` takes a share of the area (with its normal) to the force on it.
template <class Force>
Eigen::VectorXd load(const TetMesh& mesh, const std::vector<Triangle>& faces, const Force& force) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (const std::vector<int>& f : face_nodes(mesh, faces))
    for (const FacePoint& p : face_points(mesh, f))
      for (std::size_t a = 0; a < f.size(); ++a)
        result.segment<3>(3 * f[a]) += p.shape[a] * force(p.area);
  return result;
}

}  // namespace

Eigen::VectorXd traction_load(const TetMesh& mesh, const std::vector<Triangle>& faces,
                              const Vec3& traction) {
  return load(mesh, faces, [&](const Vec3& area) { return Vec3(area.norm() * traction); });
}

Eigen::VectorXd pressure_load(const TetMesh& mesh, const std::vector<Triangle>& faces,
                              double pressure) {
  return load(mesh, faces, [&](const Vec3& area) { return Vec3(-pressure * area); });
}

}  // namespace hapsim
