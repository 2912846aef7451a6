#include "fem/surface_load.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "base/error.h"

namespace hapsim {
namespace {

// traction_of(face's doubled area vector) is the force on it, doubled.
template <class Force>
Eigen::VectorXd load(const TetMesh& mesh, const std::vector<Triangle>& faces, const Force& force) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (const std::vector<int>& f : face_nodes(mesh, faces)) {
    const Vec3 cross =
        (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]);
    for (std::size_t a = f.size() - 3; a < f.size(); ++a)
      result.segment<3>(3 * f[a]) += force(cross) / 6;
  }
  return result;
}

}  // namespace

std::vector<std::vector<int>> face_nodes(const TetMesh& mesh, const std::vector<Triangle>& faces) {
  std::map<std::pair<int, int>, int> middle;
  if (mesh.order == 2)
    for (const auto& t : mesh.tets)
      for (int e = 0; e < 6; ++e)
        middle[std::minmax(t[kTetEdges[e][0]], t[kTetEdges[e][1]])] = t[4 + e];
  std::vector<std::vector<int>> result;
  for (const Triangle& f : faces) {
    std::vector<int> nodes(f.begin(), f.end());
    for (int e = 0; mesh.order == 2 && e < 3; ++e) {
      const auto found = middle.find(std::minmax(f[e], f[(e + 1) % 3]));
      if (found == middle.end())
        fail_input("", "a face is no face of the mesh", "take boundary faces");
      nodes.push_back(found->second);
    }
    result.push_back(std::move(nodes));
  }
  return result;
}

Eigen::VectorXd traction_load(const TetMesh& mesh, const std::vector<Triangle>& faces,
                              const Vec3& traction) {
  return load(mesh, faces, [&](const Vec3& cross) { return Vec3(cross.norm() * traction); });
}

Eigen::VectorXd pressure_load(const TetMesh& mesh, const std::vector<Triangle>& faces,
                              double pressure) {
  return load(mesh, faces, [&](const Vec3& cross) { return Vec3(-pressure * cross); });
}

}  // namespace hapsim
