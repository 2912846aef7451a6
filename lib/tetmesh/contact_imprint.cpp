// The graded triangles that fill the hole cut for a contact (CGAL: slow to compile).
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <numbers>

#include "tetmesh/contact_patch.h"

namespace hapsim {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

constexpr int kOutside = -1, kUnseen = 0, kInside = 1;

// A point of the patch in plan; the loop's own points come first, then the disc's, then the rest.
struct PlanPoints {
  std::vector<Eigen::Vector2d> points;
  std::size_t loop = 0, rim_begin = 0, rim_end = 0, disc_end = 0;
};

// Clear of creases, which have nodes of their own, and of the loop, whose edges are long already.
constexpr double kClear = 0.6;  // edge lengths

void add_ring(PlanPoints& plan, double radius, double size, bool staggered, int least,
              const CreaseNodes& creases, const ContactRegion* region) {
  const int n =
      std::max(least, static_cast<int>(std::lround(2 * std::numbers::pi * radius / size)));
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (i + (staggered ? 0.5 : 0.0)) / n;
    const Eigen::Vector2d p(radius * std::cos(angle), radius * std::sin(angle));
    if (creases.distance(p) >= kClear * size &&
        (region == nullptr || region->contains(p.x(), p.y(), kClear * size)))
      plan.points.push_back(p);
  }
}

// A regular polygon with the area of the disc: inscribed, it would be too soft by the share of the
// radius that it lacks, 0.5 % at radius/4. Corners move along it to where creases cross.
std::vector<Eigen::Vector2d> rim_points(int count, double rim, const CreaseNodes& creases) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    points.emplace_back(rim * std::cos(angle), rim * std::sin(angle));
  }
  std::vector<std::uint8_t> moved(points.size(), 0);
  for (const Eigen::Vector2d& p : creases.on_rim) {
    const auto nearest = static_cast<std::size_t>(
        std::min_element(points.begin(), points.end(),
                         [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                           return (a - p).squaredNorm() < (b - p).squaredNorm();
                         }) -
        points.begin());
    if (!moved[nearest]) points[nearest] = p;
    moved[nearest] = 1;
  }
  return points;
}

PlanPoints plan_points(const ContactRegion& region, double radius, const Grading& grading) {
  PlanPoints plan;
  double farthest = 0;
  for (const Eigen::Vector2d& p : region.outline) {
    plan.points.push_back(p);
    farthest = std::max(farthest, p.norm());
  }
  plan.loop = plan.rim_begin = plan.points.size();
  const double n = std::max(8.0, std::round(2 * std::numbers::pi * radius / grading.size[0]));
  const double rim =
      radius * std::sqrt(2 * std::numbers::pi / (n * std::sin(2 * std::numbers::pi / n)));
  const CreaseNodes creases = crease_nodes(region, rim, grading);
  for (const Eigen::Vector2d& p : rim_points(static_cast<int>(n), rim, creases))
    plan.points.push_back(p);
  plan.rim_end = plan.points.size();
  for (std::size_t k = 1; k < grading.size.size(); ++k) {
    const double inner = radius - grading.distance[k];
    if (inner < 0.45 * grading.size[k]) break;
    add_ring(plan, inner, grading.size[k], k % 2 != 0, 4, creases, nullptr);
  }
  if (creases.distance({0, 0}) >= 0.3 * grading.size[0]) plan.points.emplace_back(0, 0);
  for (const Eigen::Vector2d& p : creases.free)
    if (p.norm() < rim) plan.points.push_back(p);
  plan.disc_end = plan.points.size();
  for (const Eigen::Vector2d& p : creases.free)
    if (p.norm() > rim) plan.points.push_back(p);
  for (std::size_t k = 1; k < grading.size.size(); ++k) {
    const double outer = radius + grading.distance[k];
    if (outer > farthest) break;
    add_ring(plan, outer, grading.size[k], k % 2 != 0, 6, creases, &region);
  }
  return plan;
}

std::vector<Triangle> triangulate(const PlanPoints& plan) {
  Triangulation t;
  std::vector<Triangulation::Vertex_handle> handle;
  for (const auto& p : plan.points) {
    handle.push_back(t.insert(Kernel::Point_2(p.x(), p.y())));
    handle.back()->info() = static_cast<int>(handle.size()) - 1;
  }
  for (std::size_t i = 0; i < plan.loop; ++i)
    t.insert_constraint(handle[i], handle[(i + 1) % plan.loop]);
  for (std::size_t i = plan.rim_begin; i < plan.rim_end; ++i)
    t.insert_constraint(handle[i], handle[i + 1 < plan.rim_end ? i + 1 : plan.rim_begin]);

  // The loop parts inside from outside; the rim lies inside and does not count.
  for (const auto f : t.all_face_handles()) f->info() = kUnseen;
  const auto on_loop = [&](const Triangulation::Face_handle& f, int k) {
    return f->is_constrained(k) && f->vertex(t.cw(k))->info() < static_cast<int>(plan.loop) &&
           f->vertex(t.ccw(k))->info() < static_cast<int>(plan.loop);
  };
  std::vector<Triangulation::Face_handle> stack{t.infinite_face()};
  t.infinite_face()->info() = kOutside;
  while (!stack.empty()) {
    const auto f = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const auto g = f->neighbor(k);
      if (g->info() != kUnseen || on_loop(f, k)) continue;
      g->info() = kOutside;
      stack.push_back(g);
    }
  }
  std::vector<Triangle> faces;
  for (const auto f : t.finite_face_handles())
    if (f->info() != kOutside)
      faces.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return faces;
}

}  // namespace

Imprint imprint_disc(const ClassedSurface& coarse, const ContactFrame& frame,
                     const ContactRegion& region, const SheetMap& sheet, double radius,
                     const Grading& grading) {
  Imprint result;
  const PlanPoints plan = plan_points(region, radius, grading);
  std::vector<int> number(coarse.surface.vertices.size(), -1);
  const auto vertex = [&](int old) {
    if (number[old] < 0) {
      number[old] = static_cast<int>(result.surface.vertices.size());
      result.surface.vertices.push_back(coarse.surface.vertices[old]);
    }
    return number[old];
  };
  for (std::size_t f = 0; f < coarse.surface.faces.size(); ++f) {
    if (region.inside[f]) continue;
    const Triangle& t = coarse.surface.faces[f];
    result.surface.faces.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
    result.marker.push_back(coarse.face_class[f] ? kBonded : kOther);
  }
  std::vector<int> patch_vertex;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    if (i < plan.loop) {
      patch_vertex.push_back(vertex(region.loop[i]));
      continue;
    }
    const auto& p = plan.points[i];
    patch_vertex.push_back(static_cast<int>(result.surface.vertices.size()));
    result.surface.vertices.push_back(frame.to_global(sheet.at(p.x(), p.y()).point));
  }
  const auto on_disc = [&](int i) {
    return static_cast<std::size_t>(i) >= plan.rim_begin &&
           static_cast<std::size_t>(i) < plan.disc_end;
  };
  for (const Triangle& t : triangulate(plan)) {
    result.surface.faces.push_back({patch_vertex[t[0]], patch_vertex[t[1]], patch_vertex[t[2]]});
    // The rim is convex, so three nodes of the closed disc span a triangle of the disc.
    result.marker.push_back(on_disc(t[0]) && on_disc(t[1]) && on_disc(t[2]) ? kPatch : kOther);
  }
  return result;
}

}  // namespace hapsim
