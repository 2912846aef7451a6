// Between Surface and the mesh of CGAL; for files that are compiled with it alone.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <vector>

#include "mesh/surface.h"

namespace hapsim::cgal {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Faces = std::vector<std::array<std::size_t, 3>>;

inline std::vector<Point> points_of(const std::vector<Vec3>& vertices) {
  std::vector<Point> points;
  points.reserve(vertices.size());
  for (const Vec3& p : vertices) points.emplace_back(p.x(), p.y(), p.z());
  return points;
}

inline Faces faces_of(const Surface& surface) {
  Faces faces;
  faces.reserve(surface.faces.size());
  for (const Triangle& f : surface.faces) {
    faces.push_back({static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                     static_cast<std::size_t>(f[2])});
  }
  return faces;
}

// False when edges have more than two triangles, or two of unlike direction.
inline bool to_mesh(const Surface& surface, Mesh& mesh) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  const Faces faces = faces_of(surface);
  if (!PMP::is_polygon_soup_a_polygon_mesh(faces)) return false;
  PMP::polygon_soup_to_polygon_mesh(points_of(surface.vertices), faces, mesh);
  return true;
}

// Compacts the mesh: its numbers are then the surface's.
inline Surface to_surface(Mesh& mesh) {
  mesh.collect_garbage();
  Surface surface;
  for (const auto v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    surface.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : mesh.faces()) {
    Triangle face;
    int k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
      face[k++] = static_cast<int>(v.idx());
    }
    surface.faces.push_back(face);
  }
  return surface;
}

}  // namespace hapsim::cgal
