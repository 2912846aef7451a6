#include "tetmesh/plates_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "mesh/support.h"
#include "repair/coarsen.h"
#include "tetmesh/contact_patch.h"
#include "tetmesh/tetgen.h"

namespace hapsim {
namespace {

constexpr double kFlat = 0.02;       // of the height: how far below the tool a face may lie
constexpr double kUpright = 0.95;    // cosine of a face's tilt against the tool
constexpr double kLeastShare = 0.7;  // of the mean section
constexpr double kInside = 0.25;     // of the height: longest edges
constexpr CoarsenOptions kSmooth{.tolerance = 0.03, .volume_tolerance = 0.0025};

// Faces under the tool, of class 1; what is bonded keeps its class.
double mark_patch(ClassedSurface& body, const Vec3& contact, const Vec3& normal, double height) {
  double area = 0;
  for (std::size_t f = 0; f < body.surface.faces.size(); ++f) {
    const Vec3 n = face_normal(body.surface, static_cast<int>(f));
    if (n.dot(normal) < kUpright * n.norm()) continue;
    bool flat = true;
    for (const int v : body.surface.faces[f])
      flat = flat && std::abs((body.surface.vertices[v] - contact).dot(normal)) < kFlat * height;
    if (!flat) continue;
    body.face_class[f] = 1;
    area += 0.5 * n.dot(normal);
  }
  return area;
}

struct Segment {
  Vec3 a, b;
  double distance(const Vec3& p) const {
    const Vec3 d = b - a;
    const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
    return (p - a - t * d).norm();
  }
};

// Between the two classes.
std::vector<Segment> outline(const ClassedSurface& body) {
  std::map<std::pair<int, int>, int> balance;
  for (std::size_t f = 0; f < body.surface.faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Triangle& t = body.surface.faces[f];
      balance[std::minmax(t[k], t[(k + 1) % 3])] += body.face_class[f] ? 1 : -1;
    }
  std::vector<Segment> segments;
  for (const auto& [edge, sum] : balance)
    if (sum == 0)
      segments.push_back({body.surface.vertices[edge.first], body.surface.vertices[edge.second]});
  return segments;
}

}  // namespace

ContactMesh make_plates_mesh(const ContactBase& base, const Vec3& contact, const Vec3& normal,
                             double height, double rim_edge, double growth,
                             const std::string& where) {
  ClassedSurface body{base.fine, base.fine_fixed};
  const double section = signed_volume(base.fine) / height;
  const double area = mark_patch(body, contact, normal, height);
  if (area < kLeastShare * section)
    fail_input(where,
               fmt::format("the tool covers the whole body, of which {:.0f} % of the mean section "
                           "are flat under it",
                           100 * area / section),
               "check the unit of the radius; contact that grows between plates is not modelled");
  const std::vector<Segment> rim = outline(body);
  const auto edge = [&](const Vec3& p) {
    double nearest = height;
    for (const Segment& s : rim) nearest = std::min(nearest, s.distance(p));
    return std::min(rim_edge + growth * nearest, kInside * height);
  };
  body = split_long_edges(coarsen_surface(body, edge, kSmooth),
                          [&](const Vec3& p) { return 1.4 * edge(p); });

  TetgenInput input;
  for (std::size_t f = 0; f < body.surface.faces.size(); ++f) {
    const bool up = face_normal(body.surface, static_cast<int>(f)).dot(normal) > 0;
    input.face_marker.push_back(!body.face_class[f] ? kOther : up ? kPatch : kBonded);
  }
  for (const Vec3& p : body.surface.vertices) input.node_size.push_back(edge(p));
  input.surface = std::move(body.surface);
  TetgenOptions options;
  options.max_volume = std::pow(kInside * height, 3) / 6;
  const TetgenResult result = run_tetgen(input, options, where);

  ContactMesh mesh;
  mesh.mesh = to_second_order(result.mesh);
  mesh.point = contact;
  mesh.normal = normal;
  mesh.patch_area = area;
  std::vector<std::uint8_t> patch, bonded;
  for (const int m : result.face_marker) {
    patch.push_back(m == kPatch);
    bonded.push_back(m == kBonded);
  }
  mesh.patch_nodes = nodes_of_faces(mesh.mesh, patch);
  fix_faces(mesh.mesh, bonded);
  return mesh;
}

}  // namespace hapsim
