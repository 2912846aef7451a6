#include "geometry/body_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geometry/coarsen.h"
#include "geometry/tetgen.h"

namespace hapsim {
namespace {

constexpr int kFree = 1, kHeld = 2;  // face markers

// A coarse surface misplaces the contact normals later on, so it may stray less than a contact's
// base.
constexpr CoarsenOptions kCoarsen{.tolerance = 0.03, .outline_tolerance = 0.01};
// Element size over distance outside the refined surroundings of a contact.
constexpr double kGrowth = 0.5;

double wished_edge(const Surface& surface, const BodyOptions& options) {
  if (options.edge > 0) return options.edge;
  // A regular tetrahedron of edge e has the volume e^3 / (6 sqrt 2).
  if (options.max_volume > 0) return std::cbrt(6 * std::sqrt(2.0) * options.max_volume);
  return std::cbrt(3 * signed_volume(surface)) / 16;
}

double size_at(const Vec3& p, double edge, const BodyOptions& options) {
  if (options.contacts.empty()) return edge;
  double distance = 1e300;
  for (const Vec3& contact : options.contacts) distance = std::min(distance, (p - contact).norm());
  const double fine = options.tool_radius / 2;
  return std::min(edge, fine + kGrowth * std::max(0.0, distance - 1.5 * options.tool_radius));
}

std::vector<std::uint8_t> bonded_or_fail(const Surface& surface, const Support& support,
                                         const std::string& where) {
  std::vector<std::uint8_t> bonded = bonded_faces(surface.vertices, surface.faces, support);
  if (support.kind != SupportKind::kNone &&
      std::find(bonded.begin(), bonded.end(), 1) == bonded.end())
    fail_input(where, "no triangle lies where the support is",
               "give --fixed below:Z or plane:Z with Z in metres, or cut the bottom flat "
               "(hs-reconstruct)");
  return bonded;
}

}  // namespace

TetMesh make_body_mesh(const Surface& surface, const BodyOptions& options,
                       const std::string& where) {
  check_surface(surface, where);
  check_self_intersection(surface, where);
  const double edge = wished_edge(surface, options);
  const auto size = [&](const Vec3& p) { return size_at(p, edge, options); };
  ClassedSurface classed{surface, bonded_or_fail(surface, options.support, where)};
  if (!options.preserve_surface) {
    classed = coarsen_surface(classed, size, kCoarsen);
    // TetGen takes sizes from the surface's vertices: they must be dense enough to carry them.
    classed = split_long_edges(classed, [&](const Vec3& p) { return 2 * size(p); });
  }

  TetgenInput input;
  for (const auto held : classed.face_class) input.face_marker.push_back(held ? kHeld : kFree);
  for (const Vec3& p : classed.surface.vertices) input.node_size.push_back(size(p));
  input.surface = std::move(classed.surface);
  TetgenOptions tetgen;
  tetgen.radius_edge = options.radius_edge;
  tetgen.min_dihedral = options.min_dihedral;
  tetgen.max_volume = options.max_volume;
  tetgen.preserve_surface = options.preserve_surface;
  TetgenResult result = run_tetgen(input, tetgen, where);
  TetMesh mesh = options.order == 2 ? to_second_order(result.mesh) : std::move(result.mesh);
  std::vector<std::uint8_t> held;
  for (const int marker : result.face_marker) held.push_back(marker == kHeld);
  fix_faces(mesh, held);
  return mesh;
}

}  // namespace hapsim
