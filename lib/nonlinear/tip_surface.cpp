#include "nonlinear/tip_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "solid/face_quadrature.h"

namespace hapsim {

TipSurface::TipSurface(const TetMesh& mesh, const Vec3& point, const Vec3& normal, double reach) {
  std::vector<Triangle> chosen;
  std::vector<int> uses(mesh.nodes.size(), 0), all(mesh.nodes.size(), 0);
  for (const Triangle& f : mesh.faces) {
    for (const int n : f) ++all[n];
    const Vec3 cross =
        (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]);
    const bool near = std::all_of(f.begin(), f.end(),
                                  [&](int n) { return (mesh.nodes[n] - point).norm() < reach; });
    if (!near || cross.dot(normal) < 0.5 * cross.norm()) continue;
    chosen.push_back(f);
    for (const int n : f) ++uses[n];
  }
  if (chosen.empty())
    fail_input("", "the mesh has no face within reach of the contact",
               "refine the mesh there or raise the reach");
  std::vector<int> hat(mesh.nodes.size(), -1);
  int count = 0;
  for (std::size_t n = 0; n < uses.size(); ++n) {
    if (uses[n] == 0) continue;
    hat[n] = count++;
    rim.push_back(uses[n] != all[n]);
  }
  area = Eigen::VectorXd::Zero(count);
  faces = face_nodes(mesh, chosen);
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (const FacePoint& q : face_points(mesh, faces[f])) {
      Point p{f, {}, q.corner, q.shape, q.area.norm(), q.position};
      for (std::size_t i = 0; i < 3; ++i) {
        p.hat[i] = hat[faces[f][i]];
        area[p.hat[i]] += p.area * p.corner[i];
      }
      points.push_back(p);
    }
}

SphereHeight sphere_height(double R, double r) {
  const double inside = std::min(r, 0.99 * R), root = std::sqrt(R * R - inside * inside);
  return {R - root + (r - inside) * inside / root, r < 0.99 * R ? 1 - R / root : 0};
}

}  // namespace hapsim
