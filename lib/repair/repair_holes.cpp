#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "mesh/local_plane.h"
#include "repair/cgal_mesh.h"
#include "repair/repair_parts.h"

namespace hapsim {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
constexpr double kFlat = 1e-3;  // of its width: a rim this flat gets flat triangles

std::vector<Vec3> rim_of(const cgal::Mesh& mesh, cgal::Mesh::Halfedge_index start) {
  std::vector<Vec3> rim;
  auto h = start;
  do {
    const auto& p = mesh.point(mesh.target(h));
    rim.emplace_back(p.x(), p.y(), p.z());
    h = mesh.next(h);
  } while (h != start);
  return rim;
}

}  // namespace

int take_apart(Surface& surface) {
  std::vector<cgal::Point> points = cgal::points_of(surface.vertices);
  std::vector<std::vector<std::size_t>> faces;
  for (const auto& f : cgal::faces_of(surface)) faces.emplace_back(f.begin(), f.end());
  PMP::orient_polygon_soup(points, faces);
  const int fresh = static_cast<int>(points.size() - surface.vertices.size());
  surface.vertices.clear();
  for (const auto& p : points) surface.vertices.emplace_back(p.x(), p.y(), p.z());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) surface.faces[f][k] = static_cast<int>(faces[f][k]);
  }
  return fresh;
}

void close_holes(Surface& surface, const std::string& name, RepairReport& report) {
  cgal::Mesh mesh;
  if (!cgal::to_mesh(surface, mesh)) {
    fail_input(name, "triangles meet in a way no surface can", "wrap them instead: --method wrap");
  }
  PMP::stitch_borders(mesh);
  std::vector<cgal::Mesh::Halfedge_index> holes;
  PMP::extract_boundary_cycles(mesh, std::back_inserter(holes));
  for (const auto h : holes) {
    const std::vector<Vec3> rim = rim_of(mesh, h);
    double length = 0;
    Vec3 centre = Vec3::Zero();
    for (std::size_t k = 0; k < rim.size(); ++k) {
      length += (rim[k] - rim[(k + 1) % rim.size()]).norm();
      centre += rim[k] / static_cast<double>(rim.size());
    }
    const LocalPlane plane = fit_plane(rim);
    std::vector<cgal::Mesh::Face_index> patch;
    std::vector<cgal::Mesh::Vertex_index> inner;
    if (plane.thickness < kFlat * plane.spread[2] || rim.size() <= 4) {
      PMP::triangulate_hole(mesh, h, std::back_inserter(patch));
    } else {
      PMP::triangulate_refine_and_fair_hole(mesh, h, std::back_inserter(patch),
                                            std::back_inserter(inner));
    }
    if (patch.empty()) {
      fail_input(name,
                 fmt::format("a hole with a rim of {:.3g} mm about ({:.6g}, {:.6g}, {:.6g}) cannot "
                             "be closed",
                             1e3 * length, centre.x(), centre.y(), centre.z()),
                 "wrap the triangles instead: --method wrap");
    }
    ++report.holes;
    report.added_triangles += static_cast<int>(patch.size());
    if (length > report.largest_hole) {
      report.largest_hole = length;
      report.largest_hole_at = centre;
    }
  }
  surface = cgal::to_surface(mesh);
}

}  // namespace hapsim
