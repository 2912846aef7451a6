#include "reconstruct/usable_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/median.h"
#include "mesh/local_plane.h"
#include "mesh/surface_check.h"
#include "reconstruct/clean_points.h"

namespace hapsim {
namespace {

constexpr double kFarAway = 1e6;          // [m]
constexpr std::size_t kLeastPoints = 12;  // different points
constexpr double kFlat = 1e-4;            // thickness over width of points in a plane

// Points given once, in their order.
PointCloud without_doubles(const PointCloud& cloud) {
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const Vec3& p = cloud.points[i];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<char> doubled(order.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    doubled[order[i]] = key(order[i]) == key(order[i - 1]) ? 1 : 0;
  }
  PointCloud once;
  for (std::size_t i = 0; i < doubled.size(); ++i) {
    if (doubled[i] != 0) continue;
    once.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) once.normals.push_back(cloud.normals[i]);
  }
  return once;
}

// Circumcentres underflow with coordinates of 1e-200 m, and normals need not be of unit length in a
// file: what does not change the shape and would end CGAL's exact numbers.
void make_tame(PointCloud& cloud) {
  constexpr double kNothing = 1e-12;  // [m]
  for (Vec3& p : cloud.points)
    for (int k = 0; k < 3; ++k)
      if (std::abs(p[k]) < kNothing) p[k] = 0;
  for (Vec3& n : cloud.normals) {
    const double largest = n.cwiseAbs().maxCoeff();
    if (largest > 0 && std::abs(n.norm() - 1) > 1e-3) n = (n / largest).normalized();
  }
}

}  // namespace

PointCloud tame_points(const PointCloud& cloud) {
  PointCloud tame = cloud;
  make_tame(tame);
  return without_doubles(tame);
}

void require_body_points(const std::vector<Vec3>& points, ReconstructMethod method,
                         const std::string& name) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) continue;
    fail_input(name, fmt::format("point {} is not finite", i), "remove it");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double far = points[i].cwiseAbs().maxCoeff();
    if (far >= kFarAway)
      fail_input(name, fmt::format("point {} lies {:.3g} m away", i, far), "remove it");
  }
  require_surface_points(points, name);
  if (points.size() < kLeastPoints) {
    fail_input(name, fmt::format("only {} different points", points.size()),
               fmt::format("scan at least {}, better some hundred", kLeastPoints));
  }
  if (method == ReconstructMethod::kAuto || method == ReconstructMethod::kHeight) return;
  const LocalPlane plane = fit_plane(points);
  if (plane.spread[0] < kFlat * plane.spread[2]) {
    fail_input(name, "all points lie in one plane",
               "scan the sides too, or use --method height with --base-depth");
  }
}

void check_size(const std::vector<Vec3>& points, const std::string& unit, const std::string& name) {
  double size = 0;
  std::vector<double> along(points.size());
  const auto cut = static_cast<std::size_t>(0.02 * static_cast<double>(points.size()));
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = points[i][k];
    if (!along.empty())
      size = std::max(size, nth_smallest(along, along.size() - 1 - cut) - nth_smallest(along, cut));
  }
  if (size > 5) {
    fail_input(name, fmt::format("the surface is {:.3g} m wide when read in {}", size, unit),
               "give its unit, as --unit mm");
  }
  if (size < 1e-3 && size > 0) {
    fail_input(name, fmt::format("the surface is {:.3g} mm wide when read in {}", 1e3 * size, unit),
               "give its unit, as --unit m");
  }
}

}  // namespace hapsim
