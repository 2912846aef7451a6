#include "geometry/inner_regions.h"

#include <fmt/format.h>

#include "base/error.h"
#include "geometry/tetgen.h"

namespace hapsim {
namespace {

void append(Surface& all, const Surface& more) {
  const int first = static_cast<int>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Triangle& f : more.faces)
    all.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
}

std::string place(const Surface& surface, int face) {
  const Triangle& f = surface.faces[face];
  const Vec3 c = (surface.vertices[f[0]] + surface.vertices[f[1]] + surface.vertices[f[2]]) / 3;
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", c.x(), c.y(), c.z());
}

}  // namespace

InnerParts inner_parts(const Surface& outer, const std::vector<InnerRegion>& inner,
                       const std::string& where, std::vector<std::string>& notes) {
  InnerParts parts;
  if (inner.empty()) return parts;
  const SignedDistance body(outer, where);
  Surface all = outer;
  for (const InnerRegion& region : inner) {
    parts.distance.emplace_back(region.surface, region.name);
    check_self_intersection(region.surface, region.name);
    std::size_t outside = 0;
    for (const Vec3& p : region.surface.vertices) outside += body.at(p).distance >= 0;
    if (outside == region.surface.vertices.size())
      fail_input(region.name, "this region lies outside of the body",
                 "check its unit and that it shares the body's frame");
    Surface with = all;
    append(with, region.surface);
    const auto pairs = intersecting_faces(with, region.name);
    if (outside == 0 && pairs.empty()) {
      parts.bounding.push_back(region.surface);
      all = std::move(with);
      continue;
    }
    notes.push_back(
        fmt::format("region {} ({}) is not wholly inside ({}): its boundary follows the tetrahedra",
                    parts.distance.size(), region.name,
                    pairs.empty() ? fmt::format("{} vertices outside", outside)
                                  : "it meets another surface at " + place(with, pairs[0].first)));
  }
  return parts;
}

void colour_regions(TetMesh& mesh, const InnerParts& parts) {
  for (std::size_t k = 0; k < parts.distance.size(); ++k) {
    int hint = -1;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto& n = mesh.tets[t];
      const SurfaceSide side = parts.distance[k].at(
          0.25 * (mesh.nodes[n[0]] + mesh.nodes[n[1]] + mesh.nodes[n[2]] + mesh.nodes[n[3]]), hint);
      hint = side.face;
      if (side.distance < 0) mesh.region[t] = static_cast<int>(k) + 1;
    }
  }
}

}  // namespace hapsim
