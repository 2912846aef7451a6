#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_with_circumcenter_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "reconstruct/raw_surface.h"

namespace hapsim {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

struct Side {
  double vote = 0;  // -1 surely inside, 1 surely outside
  bool inside = false;
};

using Delaunay = CGAL::Delaunay_triangulation_3<
    Kernel,
    CGAL::Triangulation_data_structure_3<
        CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>,
        CGAL::Triangulation_cell_base_with_info_3<
            Side, Kernel, CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<Kernel>>>>;

constexpr double kSure = 0.4;  // below it the neighbours decide

Vec3 vec(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

double facet_area(Delaunay::Cell_handle c, int k) {
  const Vec3 a = vec(c->vertex((k + 1) % 4)->point());
  return (vec(c->vertex((k + 2) % 4)->point()) - a)
      .cross(vec(c->vertex((k + 3) % 4)->point()) - a)
      .norm();
}

}  // namespace

Surface restricted_delaunay(const PointCloud& cloud) {
  std::vector<std::pair<Point, int>> samples;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3& p = cloud.points[i];
    samples.emplace_back(Point(p.x(), p.y(), p.z()), static_cast<int>(i));
  }
  Delaunay delaunay(samples.begin(), samples.end());
  if (delaunay.dimension() < 3) {
    fail_input("", "all points lie in one plane", "scan the object from more than one side");
  }
  for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
    const Vec3 centre = vec(c->circumcenter());
    double sum = 0;
    if (centre.allFinite()) {
      for (int k = 0; k < 4; ++k) {
        const Vec3 d = centre - vec(c->vertex(k)->point());
        sum += d.dot(cloud.normals[c->vertex(k)->info()]) / (4 * std::max(d.norm(), 1e-300));
      }
    }
    c->info() = {sum, sum < 0};
  }
  // Flat tetrahedra on the surface: to the side with which they share more.
  for (int pass = 0; pass < 10; ++pass) {
    bool changed = false;
    for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
      if (std::abs(c->info().vote) > kSure) continue;
      double inside = 0, all = 0;
      for (int k = 0; k < 4; ++k) {
        const double area = facet_area(c, k);
        all += area;
        const auto other = c->neighbor(k);
        if (!delaunay.is_infinite(other) && other->info().inside) inside += area;
      }
      const bool now = inside > all / 2;
      changed = changed || now != c->info().inside;
      c->info().inside = now;
    }
    if (!changed) break;
  }
  Surface surface;
  surface.vertices = cloud.points;
  for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
    if (!c->info().inside) continue;
    for (int k = 0; k < 4; ++k) {
      const auto other = c->neighbor(k);
      if (!delaunay.is_infinite(other) && other->info().inside) continue;
      Triangle f{c->vertex((k + 1) % 4)->info(), c->vertex((k + 2) % 4)->info(),
                 c->vertex((k + 3) % 4)->info()};
      // CGAL's cells are positive: seen from outside, the corners after an even one turn clockwise.
      if (k % 2 == 0) std::swap(f[1], f[2]);
      surface.faces.push_back(f);
    }
  }
  if (surface.faces.empty()) {
    fail_numerics("", "no tetrahedron lies inside", "check the points' normals with hs-scan2ply");
  }
  return surface;
}

}  // namespace hapsim
