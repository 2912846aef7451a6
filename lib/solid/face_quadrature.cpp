#include "solid/face_quadrature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace hapsim {
namespace {

struct Rule {
  std::array<std::array<double, 3>, 7> point;
  std::array<double, 7> weight;  // sum 1
};

Rule radon() {
  Rule rule;
  const double r = std::sqrt(15.0);
  rule.point[0].fill(1.0 / 3);
  rule.weight[0] = 9.0 / 40;
  for (std::size_t s = 0; s < 2; ++s) {
    const double root = s == 0 ? -r : r, a = (6 + root) / 21;
    for (std::size_t k = 0; k < 3; ++k) {
      rule.point[1 + 3 * s + k].fill(a);
      rule.point[1 + 3 * s + k][k] = 1 - 2 * a;
      rule.weight[1 + 3 * s + k] = (155 + root) / 1200;
    }
  }
  return rule;
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

std::array<FacePoint, 7> face_points(const TetMesh& mesh, const std::vector<int>& nodes) {
  static const Rule rule = radon();
  std::array<FacePoint, 7> points;
  for (std::size_t q = 0; q < 7; ++q) {
    FacePoint& p = points[q];
    const auto& l = p.corner = rule.point[q];
    p.shape.fill(0);
    // dN/dl_1 and dN/dl_2 with l_0 = 1 - l_1 - l_2.
    std::array<std::array<double, 2>, 6> slope{};
    const auto by_l = [&](std::size_t node, std::size_t i, double value) {
      if (i == 0) slope[node][0] -= value, slope[node][1] -= value;
      if (i > 0) slope[node][i - 1] += value;
    };
    for (std::size_t a = 0; a < 3; ++a) {
      p.shape[a] = nodes.size() == 3 ? l[a] : l[a] * (2 * l[a] - 1);
      by_l(a, a, nodes.size() == 3 ? 1 : 4 * l[a] - 1);
      if (nodes.size() == 3) continue;
      const std::size_t b = (a + 1) % 3;
      p.shape[3 + a] = 4 * l[a] * l[b];
      by_l(3 + a, a, 4 * l[b]);
      by_l(3 + a, b, 4 * l[a]);
    }
    p.position.setZero();
    Vec3 u = Vec3::Zero(), v = Vec3::Zero();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      p.position += p.shape[a] * mesh.nodes[nodes[a]];
      u += slope[a][0] * mesh.nodes[nodes[a]];
      v += slope[a][1] * mesh.nodes[nodes[a]];
    }
    p.area = rule.weight[q] / 2 * u.cross(v);
    // Along the face: the base that is dual to u and v.
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
    const Vec3 by_u = (vv * u - uv * v) / det, by_v = (uu * v - uv * u) / det;
    for (std::size_t a = 0; a < 6; ++a) p.gradient[a] = slope[a][0] * by_u + slope[a][1] * by_v;
  }
  return points;
}

}  // namespace hapsim
