#include "repair/remesh.h"

#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "repair/cgal_mesh.h"

namespace hapsim {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using cgal::Kernel;
using cgal::Mesh;

Mesh to_cgal(const Surface& surface) {
  Mesh mesh;
  if (!cgal::to_mesh(surface, mesh)) {
    fail_numerics("", "the raw surface has edges of more than two triangles",
                  "use another --edge, or --method height");
  }
  return mesh;
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
  return cgal::to_surface(mesh);
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
  if (options.crease_deg < 180) PMP::detect_sharp_edges(mesh, options.crease_deg, seam);
  const int least = *std::min_element(label.begin(), label.end());
  for (const auto f : mesh.faces()) {
    const auto own = static_cast<std::size_t>(label[static_cast<std::size_t>(f)] - least);
    patch[f] = 2 * own + (flat && is_bottom(mesh, f, options.base) ? 1 : 0);
  }
  for (const auto e : mesh.edges()) {
    const auto h = mesh.halfedge(e);
    if (patch[mesh.face(h)] != patch[mesh.face(mesh.opposite(h))]) seam[e] = true;
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
  return cgal::to_surface(mesh);
}

}  // namespace hapsim
