#include "simulate/full_contact.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace hapsim {

FullContact full_contact(const TetMesh& mesh, const Vec3& at, double radius) {
  FullContact c{at, Vec3::Zero(), {}};
  double nearest = 1e300;
  for (const Triangle& f : mesh.faces)
    for (const int n : f) nearest = std::min(nearest, (mesh.nodes[n] - at).norm());
  const auto area = [&](const Triangle& f) -> Vec3 {
    return (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]);
  };
  for (const Triangle& f : mesh.faces)
    for (const int n : f)
      if ((mesh.nodes[n] - at).norm() <= nearest + 1e-9 && !mesh.fixed[n]) c.normal += area(f);
  if (c.normal.norm() == 0) return c;
  c.normal.normalize();
  std::vector<char> up(mesh.nodes.size(), 0);
  for (const Triangle& f : mesh.faces)
    if (area(f).dot(c.normal) > 0.5 * area(f).norm())
      for (const int n : f) up[n] = 1;
  if (mesh.order == 2)
    for (const auto& t : mesh.tets)
      for (int e = 0; e < 6; ++e) up[t[4 + e]] |= up[t[kTetEdges[e][0]]] && up[t[kTetEdges[e][1]]];
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (up[n] && !mesh.fixed[n] && (mesh.nodes[n] - at).norm() <= radius * (1 + 1e-6))
      c.nodes.push_back(static_cast<int>(n));
  return c;
}

}  // namespace hapsim
