#include "mesh/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <limits>

#include "mesh/surface_tree.h"

namespace hapsim {

double signed_volume(const Surface& surface) {
  if (surface.vertices.empty()) return 0;
  // About a vertex instead of the origin: the same for a closed surface, and no cancellation when
  // the body lies far away.
  const Vec3 o = surface.vertices.front();
  double sum = 0;
  for (const Triangle& f : surface.faces) {
    const Vec3 a = surface.vertices[f[0]] - o;
    const Vec3 b = surface.vertices[f[1]] - o;
    const Vec3 c = surface.vertices[f[2]] - o;
    sum += a.dot(b.cross(c));
  }
  return sum / 6;
}

double surface_area(const Surface& surface) {
  double sum = 0;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    sum += face_normal(surface, static_cast<int>(f)).norm();
  }
  return sum / 2;
}

Vec3 face_normal(const Surface& surface, int face) {
  const Triangle& f = surface.faces[face];
  const Vec3& a = surface.vertices[f[0]];
  return (surface.vertices[f[1]] - a).cross(surface.vertices[f[2]] - a);
}

bool is_closed(const Surface& surface) {
  if (surface.faces.empty()) return false;
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * surface.faces.size());
  for (const Triangle& f : surface.faces) {
    for (int k = 0; k < 3; ++k) {
      const auto from = static_cast<std::uint64_t>(f[k]);
      const auto to = static_cast<std::uint64_t>(f[(k + 1) % 3]);
      if (from == to) return false;
      edges.push_back(from << 32 | to);
    }
  }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](std::uint64_t edge) {
    return std::binary_search(edges.begin(), edges.end(), edge << 32 | edge >> 32);
  });
}

SurfacePoint nearest_point(const Surface& surface, const Vec3& p) {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    const Vec3 q = nearest_in_triangle(p, surface.vertices[t[0]], surface.vertices[t[1]],
                                       surface.vertices[t[2]]);
    const double distance = (q - p).norm();
    if (distance < best.distance) best = {q, static_cast<int>(f), distance};
  }
  return best;
}

}  // namespace hapsim
