// The surface from which all contact meshes of a body start.
#include <algorithm>
#include <cmath>

#include "mesh/surface_check.h"
#include "repair/coarsen.h"
#include "tetmesh/contact_mesh_around.h"
#include "tetmesh/contact_patch.h"

namespace hapsim {
namespace {

// A surface that a scanner's noise has roughened is evened out by a tenth of the edge length; what
// lies about the tool is laid on the fine surface again. Each step may cost half the 0.5 % of the
// volume that the whole is allowed.
constexpr CoarsenOptions kBase{.tolerance = 0.1, .volume_tolerance = 0.0025};
constexpr CoarsenOptions kFar{.outline_tolerance = 0.02, .volume_tolerance = 0.0025};

// Meshes of one position that are coarser than usual share the usual surface, so that their
// difference tells of the rim.
constexpr double kFarGrowth = 0.4;
// An edge is as long as wanted up to this factor. Within this many radii the body's own edges will
// do: on bodies as fine as that they err by some 0.2 % (bench_contact_accuracy), and shorter ones
// cost a seventh more elements.
constexpr double kLongest = 1.6, kNear = 8;
constexpr double kShortest = 1e-9;  // [m]; the contact itself may be a vertex

}  // namespace

ClassedSurface body_boundary(const TetMesh& body) {
  std::vector<int> node;
  ClassedSurface boundary{boundary_surface(body, &node), {}};
  check_surface(boundary.surface, "the body's boundary");
  for (const Triangle& f : boundary.surface.faces)
    boundary.face_class.push_back(body.fixed[node[f[0]]] && body.fixed[node[f[1]]] &&
                                  body.fixed[node[f[2]]]);
  return boundary;
}

ContactBase make_contact_base(const ClassedSurface& fine, double edge) {
  if (!(edge > 0)) edge = std::cbrt(3 * signed_volume(fine.surface)) / 9;
  ClassedSurface coarse = coarsen_surface(
      fine, [edge](const Vec3&) { return edge; }, kBase);
  coarse = split_long_edges(coarse, [edge](const Vec3&) { return kLongest * edge; });
  return {std::move(coarse.surface), std::move(coarse.face_class), fine.surface, fine.face_class};
}

ContactBase make_contact_base(const TetMesh& body, double edge) {
  return make_contact_base(body_boundary(body), edge);
}

namespace {

// Coarser far from the contact, split where still longer than wanted.
ClassedSurface graded(const ClassedSurface& surface, const Vec3& contact, double radius,
                      double growth) {
  const double slope = std::min(growth, kFarGrowth);
  const auto wanted = [&](const Vec3& p) {
    return std::max(slope * (p - contact).norm(), kShortest);
  };
  const auto longest = [&](const Vec3& p) {
    return kLongest * kFarGrowth * std::max((p - contact).norm(), kNear * radius);
  };
  return coarsen_surface(split_long_edges(surface, longest), wanted, kFar);
}

}  // namespace

ClassedSurface surface_about(const ContactBase& base, const Vec3& contact, double radius,
                             double growth) {
  return graded({base.surface, base.fixed_face}, contact, radius, growth);
}

std::vector<Surface> inner_about(const std::vector<Surface>& inner, const Vec3& contact,
                                 double radius, double growth) {
  std::vector<Surface> result;
  for (const Surface& s : inner)
    result.push_back(
        graded({s, std::vector<std::uint8_t>(s.faces.size(), 0)}, contact, radius, growth).surface);
  return result;
}

}  // namespace hapsim
