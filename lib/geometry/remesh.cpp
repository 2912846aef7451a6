#include "geometry/remesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace hapsim {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace PMP = CGAL::Polygon_mesh_processing;

Mesh to_cgal(const Surface& surface) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& p : surface.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& f : surface.faces) {
    faces.push_back({static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                     static_cast<std::size_t>(f[2])});
  }
  if (!PMP::is_polygon_soup_a_polygon_mesh(faces)) {
    fail_numerics("", "the raw surface has edges of more than two triangles",
                  "use another --edge, or --method height");
  }
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points, faces, mesh);
  return mesh;
}

Surface from_cgal(Mesh& mesh) {
  mesh.collect_garbage();
  Surface surface;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
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

// A face is of the bottom when its three corners have the bottom's height, to the bit.
bool is_bottom(const Mesh& mesh, Mesh::Face_index f, double base) {
  if (!f.is_valid()) return false;
  for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
    if (mesh.point(v).z() != base) return false;
  }
  return true;
}

}  // namespace

Surface cut_flat(const Surface& surface, double z) {
  Mesh mesh = to_cgal(surface);
  if (PMP::does_self_intersect(mesh)) {
    fail_numerics("", "the raw surface cuts itself", "use another --edge, or --method height");
  }
  // What lies on the negative side of the plane stays.
  PMP::clip(mesh, Kernel::Plane_3(0, 0, -1, z), CGAL::parameters::clip_volume(true));
  if (mesh.number_of_faces() == 0) {
    fail_numerics("", "nothing of the surface lies above the base", "give --base below the points");
  }
  PMP::triangulate_faces(mesh);
  // The cut's constructions round; what they put beside the plane lies on it.
  double height = 0;
  for (const auto v : mesh.vertices()) height = std::max(height, mesh.point(v).z() - z);
  for (const auto v : mesh.vertices()) {
    auto& p = mesh.point(v);
    if (std::abs(p.z() - z) < 1e-9 * height) p = Kernel::Point_3(p.x(), p.y(), z);
  }
  return from_cgal(mesh);
}

Surface remesh(const Surface& surface, const RemeshOptions& options) {
  std::vector<int> label(surface.faces.size(), 0);
  return remesh(surface, options, label);
}

Surface remesh(const Surface& surface, const RemeshOptions& options, std::vector<int>& label) {
  Mesh mesh = to_cgal(surface);
  const bool flat = std::isfinite(options.base);
  // Seams, and the rim of the bottom, are the borders between patches.
  auto patch = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:patch", 0).first;
  auto seam = mesh.add_property_map<Mesh::Edge_index, bool>("e:seam", false).first;
  const int least = *std::min_element(label.begin(), label.end());
  for (const auto f : mesh.faces()) {
    const auto own = static_cast<std::size_t>(label[static_cast<std::size_t>(f)] - least);
    patch[f] = 2 * own + (flat && is_bottom(mesh, f, options.base) ? 1 : 0);
  }
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge(e);
    seam[e] = patch[mesh.face(h)] != patch[mesh.face(mesh.opposite(h))];
  }
  PMP::isotropic_remeshing(
      mesh.faces(), options.edge, mesh,
      CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.rounds))
          .edge_is_constrained_map(seam)
          .face_patch_map(patch)
          .relax_constraints(false));
  if (flat) {
    // Relaxation and projection leave the bottom's vertices a rounding error off it.
    const auto box = CGAL::bounding_box(mesh.points().begin(), mesh.points().end());
    const double tolerance = 1e-9 * (box.zmax() - box.zmin());
    for (const auto v : mesh.vertices()) {
      auto& p = mesh.point(v);
      if (std::abs(p.z() - options.base) < tolerance) {
        p = Kernel::Point_3(p.x(), p.y(), options.base);
      }
    }
  }
  mesh.collect_garbage();  // which reorders
  label.clear();
  for (const auto f : mesh.faces()) label.push_back(static_cast<int>(patch[f] / 2) + least);
  return from_cgal(mesh);
}

}  // namespace hapsim
