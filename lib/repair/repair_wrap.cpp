#include <fmt/format.h>

#include <vector>

#include "base/error.h"
#include "repair/remesh.h"
#include "repair/repair.h"
#include "repair/self_intersection.h"
#include "repair/wrap.h"

namespace hapsim {
namespace {

constexpr double kGap = 1.0 / 50;      // of the size
constexpr double kOutside = 1.0 / 30;  // of the gap

}  // namespace

Surface wrap_surface(const Surface& given, double edge, const std::string& name) {
  if (given.faces.empty()) fail_input(name, "there are no triangles", "give a surface");
  Vec3 low = given.vertices.front(), high = low;
  for (std::size_t v = 0; v < given.vertices.size(); ++v) {
    const Vec3& p = given.vertices[v];
    if (!p.allFinite()) {
      fail_input(name, fmt::format("vertex {} is not finite", v), "remove its triangles");
    }
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double gap = edge > 0 ? edge : kGap * (high - low).norm();
  if (!(gap > 0)) fail_input(name, "all vertices are at one place", "give a surface");
  return wrap_triangles(given, gap, kOutside * gap);
}

Surface even_surface(const Surface& surface, double edge) {
  RemeshOptions options;
  options.edge = edge;
  options.crease_deg = 40;
  Surface even = remesh(surface, options);
  check_self_intersection(even, "");
  return even;
}

PointCloud points_of_triangles(const Surface& surface) {
  std::vector<Vec3> normal(surface.vertices.size(), Vec3::Zero());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    for (const int v : surface.faces[f]) normal[v] += face_normal(surface, static_cast<int>(f));
  }
  PointCloud cloud;
  for (std::size_t v = 0; v < normal.size(); ++v) {
    if (!(normal[v].norm() > 0)) continue;
    cloud.points.push_back(surface.vertices[v]);
    cloud.normals.push_back(normal[v].normalized());
  }
  return cloud;
}

}  // namespace hapsim
