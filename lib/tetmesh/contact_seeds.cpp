// How the elements grow away from the rim, on the surface and below it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/surface_tree.h"
#include "tetmesh/contact_patch.h"

namespace hapsim {
namespace {

// Distance between rows of even triangles or tetrahedra over their edge length.
constexpr double kRow = 0.87;

constexpr double kOtherSide = 0.766;  // cosine of 40 degrees, between normals

// Parity of the surface's sheets above p along the frame's normal.
bool is_inside(const std::vector<Vec3>& local, const Surface& surface, const Vec3& p) {
  bool inside = false;
  for (const Triangle& f : surface.faces) {
    const Vec3 &a = local[f[0]], &b = local[f[1]], &c = local[f[2]];
    const auto turn = [&](const Vec3& s, const Vec3& e) {
      return (e.x() - s.x()) * (p.y() - s.y()) - (e.y() - s.y()) * (p.x() - s.x());
    };
    const double wc = turn(a, b), wa = turn(b, c), wb = turn(c, a);
    if (!((wa > 0 && wb > 0 && wc > 0) || (wa < 0 && wb < 0 && wc < 0))) continue;
    if ((wa * a.z() + wb * b.z() + wc * c.z()) / (wa + wb + wc) > p.z()) inside = !inside;
  }
  return inside;
}

}  // namespace

Grading rim_grading(double rim_edge, double growth, double largest_distance, double largest_size) {
  Grading grading{{0}, {rim_edge}};
  while (grading.distance.back() < largest_distance) {
    // The size is wanted half-way to the next row.
    const double size = std::min(grading.size.back(), largest_size);
    const double step = kRow * size * (1 + 0.25 * growth);
    grading.distance.push_back(grading.distance.back() + step);
    grading.size.push_back(std::min(rim_edge + growth * grading.distance.back(), largest_size));
  }
  return grading;
}

std::vector<Vec3> rim_seeds(const Surface& surface, const ContactFrame& frame,
                            const SheetMap& sheet, double radius, const Grading& grading,
                            double depth) {
  std::vector<Vec3> local;
  for (const Vec3& p : surface.vertices) local.push_back(frame.to_local(p));
  const SurfaceTree tree(surface);
  std::vector<Vec3> seeds, normals;
  for (std::size_t k = 1; k < grading.size.size() && grading.distance[k] <= depth; ++k) {
    const double distance = grading.distance[k], size = grading.size[k];
    const int parts =
        std::max(2, static_cast<int>(std::lround(std::numbers::pi * distance / size)));
    for (int i = 1; i < parts; ++i) {
      const double ring = radius - distance * std::cos(std::numbers::pi * i / parts);
      if (ring < 0) continue;
      const double below = distance * std::sin(std::numbers::pi * i / parts);
      const int n =
          ring < 0.3 * size
              ? 1
              : std::max(3, static_cast<int>(std::lround(2 * std::numbers::pi * ring / size)));
      for (int j = 0; j < n; ++j) {
        const double angle =
            2 * std::numbers::pi * (j + ((k + static_cast<std::size_t>(i)) % 2) * 0.5) / n;
        const double r = n == 1 ? 0 : ring;
        const double u = r * std::cos(angle), v = r * std::sin(angle);
        const SheetMap::Spot spot = sheet.at(u, v);
        const Vec3 p = spot.point - below * spot.normal;
        if (!is_inside(local, surface, p)) continue;
        const Vec3 seed = frame.to_global(p);
        if (tree.nearest(seed).distance < 0.5 * size) continue;
        // From both sides of an edge they come to the same places.
        bool taken = false;
        for (std::size_t s = 0; s < seeds.size() && sheet.has_creases() && !taken; ++s)
          taken = normals[s].dot(spot.normal) < kOtherSide && (seeds[s] - seed).norm() < 0.6 * size;
        if (taken) continue;
        normals.push_back(spot.normal);
        seeds.push_back(seed);
      }
    }
  }
  return seeds;
}

}  // namespace hapsim
