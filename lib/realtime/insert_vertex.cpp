#include "realtime/insert_vertex.h"

#include <Eigen/Geometry>

namespace hapsim {
namespace {

// Splits the triangle at the edge from its corner `k` to the next.
void split_edge(Surface& surface, std::size_t face, int k, int vertex) {
  const Triangle t = surface.faces[face];
  const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
  surface.faces[face] = {a, vertex, c};
  surface.faces.push_back({vertex, b, c});
}

}  // namespace

Vec3 corner_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
  const double scale = 1 / (uu * vv - uv * uv);
  const double second = (vv * wu - uv * wv) * scale, third = (uu * wv - uv * wu) * scale;
  return {1 - second - third, second, third};
}

int insert_vertex(Surface& surface, int face, const Vec3& p) {
  const Triangle t = surface.faces[face];
  const Vec3 weight =
      corner_weights(p, surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
  int corner = 0, opposite = 0;
  if (weight.maxCoeff(&corner) > 1 - kOnEdge) return t[corner];
  const int vertex = static_cast<int>(surface.vertices.size());
  surface.vertices.push_back(p);
  if (weight.minCoeff(&opposite) > kOnEdge) {
    surface.faces[face] = {t[0], t[1], vertex};
    surface.faces.push_back({t[1], t[2], vertex});
    surface.faces.push_back({t[2], t[0], vertex});
    return vertex;
  }
  const int a = t[(opposite + 1) % 3], b = t[(opposite + 2) % 3];
  const std::size_t faces = surface.faces.size();
  for (std::size_t f = 0; f < faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const Triangle& s = surface.faces[f];
      const int from = s[k], to = s[(k + 1) % 3];
      if ((from == a && to == b) || (from == b && to == a)) {
        split_edge(surface, f, k, vertex);
        break;
      }
    }
  return vertex;
}

}  // namespace hapsim
