#include "plan/pressable_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "mesh/surface_tree.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostPlaces = 400;
constexpr double kDiscAround = 1.3, kDiscGap = 0.25;  // tool radii
constexpr double kDiscSameWay = 0.75;                 // cosine between the normals, as far as that

// Points of a face that lie `apart` from each other or closer.
void sample_face(const Surface& surface, int face, double apart, std::vector<Vec3>& points) {
  const Triangle& f = surface.faces[static_cast<std::size_t>(face)];
  const Vec3 &a = surface.vertices[f[0]], &b = surface.vertices[f[1]], &c = surface.vertices[f[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int n = std::clamp(static_cast<int>(std::ceil(longest / apart)), 1, 60);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      const double s = (i + 1.0 / 3) / n, t = (j + 1.0 / 3) / n;
      points.push_back(a + s * (b - a) + t * (c - a));
    }
}

bool goes_on_around(const SurfaceTree& tree, const PressablePlace& place, double tool_radius) {
  const Vec3 along = place.normal.unitOrthogonal(), across = place.normal.cross(along);
  constexpr int kWays = 12;
  for (int k = 0; k < kWays; ++k) {
    const double turn = 2 * M_PI * k / kWays;
    const SurfacePoint near =
        tree.nearest(place.point + kDiscAround * tool_radius *
                                       (std::cos(turn) * along + std::sin(turn) * across));
    if (near.face < 0 || near.distance > kDiscGap * tool_radius ||
        face_normal(tree.surface(), near.face).normalized().dot(place.normal) < kDiscSameWay)
      return false;
  }
  return true;
}

}  // namespace

std::vector<PressablePlace> pressable_places(const Surface& surface, double tool_radius,
                                             double steepest) {
  const SurfaceTree tree(surface);
  double area = 0;  // of what looks up
  std::vector<int> faces;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Vec3 normal = face_normal(surface, static_cast<int>(f));
    if (!(normal.z() > std::cos(steepest) * normal.norm())) continue;
    faces.push_back(static_cast<int>(f));
    area += normal.norm() / 2;
  }
  // One a cubic cell, the first in the order of the faces.
  const double cell = std::max(tool_radius, std::sqrt(area / static_cast<double>(kMostPlaces)));
  std::map<std::tuple<long, long, long>, PressablePlace> by_cell;
  std::vector<Vec3> points;
  for (const int f : faces) {
    points.clear();
    sample_face(surface, f, cell, points);
    const Vec3 normal = face_normal(surface, f).normalized();
    for (const Vec3& p : points) {
      const std::tuple<long, long, long> key{std::lround(p.x() / cell), std::lround(p.y() / cell),
                                             std::lround(p.z() / cell)};
      const PressablePlace place{p, normal};
      if (!by_cell.contains(key) && goes_on_around(tree, place, tool_radius))
        by_cell.emplace(key, place);
    }
  }
  std::vector<PressablePlace> places;
  for (const auto& [key, place] : by_cell) places.push_back(place);
  return places;
}

}  // namespace hapsim
