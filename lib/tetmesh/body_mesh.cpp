#include "tetmesh/body_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>

#include "base/error.h"
#include "mesh/surface_check.h"
#include "mesh/surface_tree.h"
#include "repair/coarsen.h"
#include "repair/self_intersection.h"
#include "tetmesh/curve_edges.h"
#include "tetmesh/inner_regions.h"
#include "tetmesh/insert_points.h"
#include "tetmesh/tetgen.h"

namespace hapsim {
namespace {

constexpr int kFree = 1, kHeld = 2;  // face markers

// A coarse surface misplaces the contact normals later on, so it may stray less than a contact's
// base.
constexpr CoarsenOptions kCoarsen{.tolerance = 0.03, .outline_tolerance = 0.01};

double wished_edge(const Surface& surface, const BodyOptions& options) {
  if (options.edge > 0) return options.edge;
  // A regular tetrahedron of edge e has the volume e^3 / (6 sqrt 2).
  if (options.max_volume > 0) return std::cbrt(6 * std::sqrt(2.0) * options.max_volume);
  return std::cbrt(3 * signed_volume(surface)) / 16;
}

// Memory ends at some hundred bytes a tetrahedron before time does.
void check_number(const Surface& surface, double edge, const BodyOptions& options,
                  const std::string& where) {
  constexpr double kMost = 3e7;
  double one = edge * edge * edge / (6 * std::sqrt(2.0));
  if (options.max_volume > 0) one = std::min(one, options.max_volume);
  if (const double count = signed_volume(surface) / one; count > kMost)
    fail_input(where, fmt::format("the wished size makes about {:.2g} tetrahedra", count),
               "give a larger --edge or --max-volume, or the right --unit");
}

double size_at(const Vec3& p, double edge, const BodyOptions& options) {
  if (options.contacts.empty()) return edge;
  double squared = 1e300;
  for (const Vec3& contact : options.contacts)
    squared = std::min(squared, (p - contact).squaredNorm());
  const double fine = options.contact_size > 0 ? options.contact_size : options.tool_radius / 2;
  const double beyond = std::sqrt(squared) - 1.5 * options.tool_radius;
  return std::min(edge, fine + options.growth * std::max(0.0, beyond));
}

std::vector<std::uint8_t> bonded_or_fail(const Surface& surface, const Support& support,
                                         const std::string& where) {
  std::vector<std::uint8_t> bonded = bonded_faces(surface.vertices, surface.faces, support);
  if (bonds_faces(support) && std::find(bonded.begin(), bonded.end(), 1) == bonded.end())
    fail_input(where, "no triangle lies where the support is",
               "give --fixed below:Z or plane:Z with Z in metres, or cut the bottom flat "
               "(hs-reconstruct)");
  return bonded;
}

// The contacts, laid on the surface as it was given.
std::vector<Vec3> contacts_on(const Surface& surface, const BodyOptions& options) {
  std::vector<Vec3> points;
  if (options.contacts.empty()) return points;
  const SurfaceTree tree(surface);
  for (const Vec3& contact : options.contacts) {
    const SurfacePoint at = tree.nearest(contact);
    if (!(at.distance <= std::max(3 * options.tool_radius, 0.01)))
      fail_input(
          fmt::format("contact at ({:.6g}, {:.6g}, {:.6g})", contact.x(), contact.y(), contact.z()),
          fmt::format("lies {:.3g} m off the surface, more than 3 tool radii", at.distance),
          "check the unit and that the surface and the recording share one frame");
    points.push_back(at.point);
  }
  return points;
}

// TetGen meshes many a surface that cuts itself, wrongly; the search for such places runs beside it
// and ends it when it finds one.
TetgenResult run_checked(const TetgenInput& input, TetgenOptions options, const Surface& surface,
                         const std::string& where) {
  auto check = std::async(std::launch::async, [&] { check_self_intersection(surface, where); });
  const auto& beat = options.heartbeat;
  TetgenOptions watched = options;
  watched.heartbeat = [&] {
    if (check.valid() && check.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      check.get();
    if (beat) beat();
  };
  TetgenResult result = run_tetgen(input, watched, where);
  if (check.valid()) check.get();
  return result;
}

TetgenOptions tetgen_options(const BodyOptions& options) {
  TetgenOptions tetgen;
  tetgen.radius_edge = options.plain ? 0 : options.radius_edge;
  tetgen.min_dihedral = options.min_dihedral;
  tetgen.max_volume = options.plain ? 0 : options.max_volume;
  tetgen.preserve_surface = options.plain || options.preserve_surface;
  tetgen.time_limit = options.time_limit;
  tetgen.heartbeat = options.heartbeat;
  return tetgen;
}

void curve(TetMesh& mesh, const BodyOptions& options, BodyReport& report) {
  if (options.curved_to.faces.empty()) return;
  const CurvedEdges curved = curve_edges(mesh, options.curved_to);
  report.notes.push_back(
      fmt::format("{} boundary nodes laid on the smooth surface, at most {:.2g} m away; {} left "
                  "where they were, for a tetrahedron would fold",
                  curved.moved, curved.farthest, curved.straight));
}

}  // namespace

TetMesh make_body_mesh(const Surface& surface, const BodyOptions& options, const std::string& where,
                       BodyReport* report) {
  BodyReport unread;
  if (report == nullptr) report = &unread;
  check_surface(surface, where);
  const double edge = wished_edge(surface, options);
  check_number(surface, edge, options, where);
  const auto size = [&](const Vec3& p) { return size_at(p, edge, options); };
  ClassedSurface classed{surface, bonded_or_fail(surface, options.support, where)};
  const std::vector<Vec3> contacts = contacts_on(surface, options);
  report->contact_node.assign(contacts.size(), -1);
  if (!options.preserve_surface) {
    check_self_intersection(surface, where);
    classed = coarsen_surface(classed, size, kCoarsen);
    // TetGen takes sizes from the surface's vertices: they must be dense enough to carry them.
    classed = split_long_edges(classed, [&](const Vec3& p) { return 2 * size(p); });
    report->contact_node = insert_points(classed, contacts);
  }

  TetgenInput input;
  for (const auto held : classed.face_class) input.face_marker.push_back(held ? kHeld : kFree);
  if (!options.plain)
    for (const Vec3& p : classed.surface.vertices) input.node_size.push_back(size(p));
  input.surface = std::move(classed.surface);
  const InnerParts inner = inner_parts(input.surface, options.inner, where, report->notes);
  input.inner = inner.bounding;
  const TetgenOptions tetgen = tetgen_options(options);
  TetgenResult result = options.preserve_surface ? run_checked(input, tetgen, surface, where)
                                                 : run_tetgen(input, tetgen, where);
  colour_regions(result.mesh, inner, options.inner);
  TetMesh mesh = options.order == 2 ? to_second_order(result.mesh) : std::move(result.mesh);
  std::vector<std::uint8_t> held;
  held.reserve(result.face_marker.size());
  for (const int marker : result.face_marker) held.push_back(marker == kHeld);
  fix_faces(mesh, held);
  fix_named_nodes(mesh, options.support, where);
  curve(mesh, options, *report);
  return mesh;
}

}  // namespace hapsim
