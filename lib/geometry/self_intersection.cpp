#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "geometry/tetgen.h"

namespace hapsim {

void check_self_intersection(const Surface& surface, const std::string& where) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  namespace PMP = CGAL::Polygon_mesh_processing;
  std::vector<Kernel::Point_3> points;
  for (const Vec3& p : surface.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& f : surface.faces)
    faces.push_back({static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                     static_cast<std::size_t>(f[2])});
  if (!PMP::is_polygon_soup_a_polygon_mesh(faces))
    fail_input(where, "triangles meet in a way no surface can (a vertex or edge is shared twice)",
               "run hs-reconstruct to get a closed clean surface");
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points, faces, mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  PMP::self_intersections<CGAL::Sequential_tag>(mesh, std::back_inserter(pairs));
  if (pairs.empty()) return;
  std::pair<int, int> first(static_cast<int>(surface.faces.size()), 0);
  for (const auto& [a, b] : pairs) {
    const int i = static_cast<int>(a), k = static_cast<int>(b);
    first = std::min(first, {std::min(i, k), std::max(i, k)});
  }
  const auto centre = [&](int face) {
    const Triangle& f = surface.faces[face];
    return Vec3((surface.vertices[f[0]] + surface.vertices[f[1]] + surface.vertices[f[2]]) / 3);
  };
  const Vec3 a = centre(first.first), b = centre(first.second);
  fail_input(where,
             fmt::format("the surface cuts itself: {} pairs of triangles, the first {} at ({:.6g}, "
                         "{:.6g}, {:.6g}) and {} at ({:.6g}, {:.6g}, {:.6g})",
                         pairs.size(), first.first, a.x(), a.y(), a.z(), first.second, b.x(), b.y(),
                         b.z()),
             "run hs-reconstruct to get a closed clean surface");
}

}  // namespace hapsim
