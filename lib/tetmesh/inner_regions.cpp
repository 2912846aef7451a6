#include "tetmesh/inner_regions.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "repair/self_intersection.h"
#include "tetmesh/tetgen.h"

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
    const auto& vertices = region.surface.vertices;
    const auto inside = static_cast<std::size_t>(std::count_if(
        vertices.begin(), vertices.end(), [&](const Vec3& p) { return body.at(p).distance < 0; }));
    Surface with = all;
    append(with, region.surface);
    const auto pairs = intersecting_faces(with, region.name);
    if (inside == vertices.size() && pairs.empty()) {
      parts.bounding.push_back(region.surface);
      all = std::move(with);
      continue;
    }
    notes.push_back(fmt::format(
        "region {} ({}) is not wholly inside ({}): its boundary follows the tetrahedra",
        parts.distance.size(), region.name,
        pairs.empty() ? fmt::format("{} of its {} vertices are", inside, vertices.size())
                      : "it meets another surface at " + place(with, pairs[0].first)));
  }
  return parts;
}

void colour_regions(TetMesh& mesh, const InnerParts& parts, const std::vector<InnerRegion>& inner) {
  for (std::size_t k = 0; k < parts.distance.size(); ++k) {
    int hint = -1;
    std::size_t count = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const SurfaceSide side = parts.distance[k].at(tet_centroid(mesh, t), hint);
      hint = side.face;
      if (side.distance >= 0) continue;
      mesh.region[t] = static_cast<int>(k) + 1;
      ++count;
    }
    if (count == 0)
      fail_input(inner[k].name,
                 "no tetrahedron lies in this region: it is outside of the body, or "
                 "cuts it and is smaller than the elements",
                 "check its unit and frame, or mesh with a smaller --edge");
  }
}

}  // namespace hapsim
