#include "realtime/curved_face.h"

#include <array>
#include <cmath>

#include "realtime/insert_vertex.h"

namespace hapsim {
namespace {

constexpr double kCrease = 0.42;  // sine of 25 degrees

// The control point of edge p to q that is nearer to p, where the normal is n.
Vec3 control_point(const Vec3& p, const Vec3& q, const Vec3& n) {
  const Vec3 edge = q - p;
  const double leaves = edge.dot(n);
  const bool crease = std::abs(leaves) > kCrease * edge.norm();
  return p + (edge - (crease ? 0 : leaves) * n) / 3;
}

}  // namespace

double curved_height(const SignedDistance& surface, int face, const Vec3& point, Vec3& normal) {
  const Triangle& corner = surface.surface().faces[face];
  std::array<Vec3, 3> p, n;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = surface.surface().vertices[corner[k]];
    n[k] = surface.vertex_normal(corner[k]);
  }
  const Vec3 w = corner_weights(point, p[0], p[1], p[2]);
  normal = (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]).normalized();
  Vec3 cubic = Vec3::Zero(), edges = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    cubic += w[i] * w[i] * w[i] * p[static_cast<std::size_t>(i)];
    for (int j = 0; j < 3; ++j) {
      if (j == i) continue;
      const Vec3 b = control_point(p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)],
                                   n[static_cast<std::size_t>(i)]);
      cubic += 3 * w[i] * w[i] * w[j] * b;
      edges += b / 6;
    }
  }
  const Vec3 flat = (p[0] + p[1] + p[2]) / 3;
  cubic += 6 * w[0] * w[1] * w[2] * (edges + 0.5 * (edges - flat));
  return (cubic - point).dot(normal);
}

}  // namespace hapsim
