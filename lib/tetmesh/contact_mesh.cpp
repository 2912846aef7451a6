#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/error.h"
#include "mesh/between_plates.h"
#include "mesh/support.h"
#include "mesh/surface_tree.h"
#include "tetmesh/contact_mesh_around.h"
#include "tetmesh/contact_patch.h"
#include "tetmesh/contact_unfit.h"
#include "tetmesh/plates_mesh.h"
#include "tetmesh/tetgen.h"

namespace hapsim {
namespace {

// Below the rim, elements are seeded down to this depth over the radius; TetGen fills the rest.
constexpr double kSeedDepth = 4;
// A plate is not wider than this, over the disc of the body's mean section: a wrong unit is.
constexpr double kMostCover = 20;

// Radii of the hole cut for the patch, and how the normal is taken, in the order in which they are
// tried: the first nearly always serves; the later ones are for edges, creases and noise.
struct Trial {
  double reach;   // of the faces replaced, over the radius
  double spread;  // of the surface that makes the normal, over the radius
  double tilt_deg;
};
constexpr Trial kTrials[] = {
    {2.8, 1, 100},  {2.4, 1, 100}, {2, 1, 100},  {3.3, 1, 100}, {1.6, 1, 100}, {1.3, 1, 100},
    {2.8, 1, 70},   {2, 1, 70},    {1.3, 1, 70}, {2, 1, 80},    {1.3, 1, 80},  {2.4, 1.5, 75},
    {1.5, 1.5, 80}, {2.4, 2, 75},  {1.5, 2, 80}, {2.6, 3, 75},  {1.5, 3, 80},  {4, 1, 65},
    {1.15, 1, 85},  {2.8, 4, 80},  {1.15, 2, 85}};

// What lies inside is what cannot be meshed where so many have failed.
constexpr int kInnerTrials = 4;

std::string place(const Vec3& p) {
  return fmt::format("contact at ({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

SurfacePoint on_surface(const ContactBase& base, const Vec3& contact, double radius) {
  const SurfacePoint nearest = nearest_point(base.fine, contact);
  if (!(nearest.distance <= std::max(3 * radius, 0.01)))
    fail_input(
        place(contact),
        fmt::format("lies {:.3g} m off the surface, more than 3 tool radii", nearest.distance),
        "check the unit and that the body and the recording share one frame");
  return nearest;
}

// The mesh between plates, if the tool covers the whole body.
std::optional<ContactMesh> between_plates(const ContactBase& base, const SurfacePoint& at,
                                          double radius, double rim_edge, double growth) {
  const Vec3 normal = face_normal(base.fine, at.face).normalized();
  const double height = height_between_plates(base.fine, at.point, normal, radius);
  if (height == 0) return std::nullopt;
  const double like_disc = std::sqrt(signed_volume(base.fine) / height / std::numbers::pi);
  if (radius > kMostCover * like_disc)
    fail_input(place(at.point),
               fmt::format("a tool of radius {:.3g} m covers the whole body {:.2g} times", radius,
                           radius / like_disc),
               "check the unit of the radius");
  return make_plates_mesh(base, at.point, normal, height,
                          rim_edge / radius * std::min(like_disc, height), growth, place(at.point));
}

void check_bonded(const ContactBase& base, const Vec3& contact, const SurfacePoint& nearest,
                  double radius) {
  const Vec3 normal = face_normal(base.fine, nearest.face).normalized();
  for (std::size_t f = 0; f < base.surface.faces.size(); ++f) {
    if (!base.fixed_face[f]) continue;
    const Triangle& t = base.surface.faces[f];
    // A face that looks the other way is the far side of a thin body, not what the tool touches.
    if (face_normal(base.surface, static_cast<int>(f)).normalized().dot(normal) < -0.5) continue;
    const Vec3 q = nearest_in_triangle(nearest.point, base.surface.vertices[t[0]],
                                       base.surface.vertices[t[1]], base.surface.vertices[t[2]]);
    if ((q - nearest.point).norm() < radius)
      throw ContactUnfit(ExitCode::kBadInput, place(contact),
                         "the tool's patch meets the bonded part of the surface",
                         "leave out this contact, or bond less of the body (hs-tetmesh --fixed)");
  }
}

double mean_edge(const Surface& surface, const std::vector<int>& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += (surface.vertices[loop[i]] - surface.vertices[loop[(i + 1) % loop.size()]]).norm();
  return sum / static_cast<double>(loop.size());
}

// The stress about the rim of a bonded flat tool grows as r^(-1/2). Moving the middles of the edges
// that end at the rim to the quarter next to it lets second-order elements follow (Henshell and
// Shaw, 1975; Barsoum, Int. J. Numer. Methods Eng. 10, 1976).
void move_middles_to_quarters(TetMesh& mesh, const std::vector<Triangle>& patch) {
  std::map<std::pair<int, int>, int> uses;
  for (const Triangle& t : patch)
    for (int k = 0; k < 3; ++k) ++uses[std::minmax({t[k], t[(k + 1) % 3]})];
  std::vector<std::uint8_t> rim(mesh.nodes.size(), 0);
  for (const auto& [edge, count] : uses)
    if (count == 1) rim[edge.first] = rim[edge.second] = 1;
  for (const auto& tet : mesh.tets)
    for (int e = 0; e < 6; ++e) {
      int near = tet[kTetEdges[e][0]], far = tet[kTetEdges[e][1]];
      if (rim[near] == rim[far]) continue;
      if (rim[far]) std::swap(near, far);
      mesh.nodes[tet[4 + e]] = 0.75 * mesh.nodes[near] + 0.25 * mesh.nodes[far];
    }
}

// Takes away the seeds that are nearer to a surface than half of its edges.
void keep_clear(std::vector<Vec3>& seeds, const Surface& inner) {
  const SurfaceTree tree(inner);
  double edges = 0;
  for (const Triangle& t : inner.faces)
    edges += (inner.vertices[t[0]] - inner.vertices[t[1]]).norm();
  const double clear = 0.5 * edges / static_cast<double>(inner.faces.size());
  std::erase_if(seeds, [&](const Vec3& p) { return tree.nearest(p).distance < clear; });
}

ContactMesh finish(const TetgenResult& result, const ContactFrame& frame) {
  ContactMesh contact;
  contact.mesh = to_second_order(result.mesh);
  contact.point = frame.origin;
  contact.normal = frame.normal;
  const auto marked = [&](int marker) {
    std::vector<std::uint8_t> chosen;
    for (const int m : result.face_marker) chosen.push_back(m == marker);
    return chosen;
  };
  contact.patch_nodes = nodes_of_faces(contact.mesh, marked(kPatch));
  fix_faces(contact.mesh, marked(kBonded));
  std::vector<Triangle> patch;
  for (std::size_t f = 0; f < contact.mesh.faces.size(); ++f) {
    if (result.face_marker[f] != kPatch) continue;
    const Triangle& t = patch.emplace_back(contact.mesh.faces[f]);
    const auto& x = contact.mesh.nodes;
    contact.patch_area += 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
  }
  move_middles_to_quarters(contact.mesh, patch);
  return contact;
}

}  // namespace

ContactMesh make_contact_mesh(const ContactBase& base, const Vec3& contact, double radius,
                              double rim_edge, double growth) {
  return make_contact_mesh_around(base, contact, radius, rim_edge, growth, {});
}

ContactMesh make_contact_mesh_around(const ContactBase& base, const Vec3& contact, double radius,
                                     double rim_edge, double growth,
                                     const std::vector<Surface>& inner) {
  const SurfacePoint nearest = on_surface(base, contact, radius);
  if (auto covered = between_plates(base, nearest, radius, rim_edge, growth)) return *covered;
  check_bonded(base, contact, nearest, radius);
  const ClassedSurface coarse = surface_about(base, contact, radius, growth);
  std::string last = "the disc does not fit on the surface";
  int failed = 0;
  for (const Trial& trial : kTrials) {
    const ContactFrame frame = contact_frame(base.fine, contact, trial.spread * radius);
    const auto region = contact_region(coarse, frame, trial.reach * radius, trial.tilt_deg,
                                       radius + std::max(0.18 * radius, 0.7 * rim_edge));
    if (!region) continue;
    const SheetMap sheet(base.fine, coarse.surface, frame, *region);
    const Grading grading =
        rim_grading(rim_edge, growth, 100 * radius,
                    std::max(mean_edge(coarse.surface, region->loop), rim_edge));
    Imprint imprint = imprint_disc(coarse, frame, *region, sheet, radius, grading);
    TetgenInput input;
    input.seeds = rim_seeds(imprint.surface, frame, sheet, radius, grading, kSeedDepth * radius);
    input.inner = inner;
    for (const Surface& part : inner) keep_clear(input.seeds, part);
    input.surface = std::move(imprint.surface);
    input.face_marker = std::move(imprint.marker);
    TetgenOptions options;
    options.time_limit = 10;
    // On a busy machine the same trial must come through: another one is another mesh.
    options.processor_time = true;
    try {
      ContactMesh mesh = finish(run_tetgen(input, options, place(contact)), frame);
      mesh.follows_inner = !inner.empty();
      return mesh;
    } catch (const Error& error) {
      last = error.what();
      if (!inner.empty() && ++failed == kInnerTrials) break;
    }
  }
  throw ContactUnfit(
      ExitCode::kBadInput, place(contact), "cannot be meshed (" + last + ")",
      "move the contact away from sharp edges, or mesh the body again with hs-tetmesh");
}

}  // namespace hapsim
