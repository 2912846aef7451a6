#include "repair/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/error.h"

namespace hapsim {

namespace {

constexpr std::size_t kNamed = 3;  // pairs told of

std::string named(const Surface& surface, int face) {
  const Triangle& f = surface.faces[face];
  const Vec3 c = (surface.vertices[f[0]] + surface.vertices[f[1]] + surface.vertices[f[2]]) / 3;
  return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g})", face, c.x(), c.y(), c.z());
}

}  // namespace

std::vector<std::pair<int, int>> intersecting_faces(const Surface& surface,
                                                    const std::string& where) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  namespace PMP = CGAL::Polygon_mesh_processing;
  std::vector<Kernel::Point_3> points;
  points.reserve(surface.vertices.size());
  for (const Vec3& p : surface.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  faces.reserve(surface.faces.size());
  for (const Triangle& f : surface.faces)
    faces.push_back({static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                     static_cast<std::size_t>(f[2])});
  if (!PMP::is_polygon_soup_a_polygon_mesh(faces))
    fail_input(where, "triangles meet in a way no surface can (a vertex or edge is shared twice)",
               "run hs-reconstruct to get a closed clean surface");
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points, faces, mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  PMP::self_intersections<CGAL::Sequential_tag>(mesh, std::back_inserter(found));
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(found.size());
  for (const auto& [a, b] : found)
    pairs.emplace_back(std::minmax({static_cast<int>(a), static_cast<int>(b)}));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void check_self_intersection(const Surface& surface, const std::string& where) {
  const auto pairs = intersecting_faces(surface, where);
  if (pairs.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < std::min(kNamed, pairs.size()); ++i)
    list += fmt::format("{}{} and {}", i == 0 ? "" : ", ", named(surface, pairs[i].first),
                        named(surface, pairs[i].second));
  fail_input(where,
             fmt::format("the surface cuts itself: {} pairs of triangles{} {} (counted from 0)",
                         pairs.size(), pairs.size() > kNamed ? ", the first" : ":", list),
             "run hs-reconstruct to get a closed clean surface");
}

}  // namespace hapsim
