#include "tetmesh/tetgen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "mesh/surface_check.h"
#include "mesh/surface_tree.h"
#include "repair/self_intersection.h"
#include "tetmesh/tetgen_child.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "mend the surface: hs-reconstruct makes a closed clean one";

Triangle sorted(Triangle f) {
  std::sort(f.begin(), f.end());
  return f;
}

// mesh.faces ascend by their sorted corners: one walk beside TetGen's, sorted alike.
std::vector<int> markers_of(const TetMesh& mesh, const TetgenAnswer& answer) {
  std::vector<std::pair<Triangle, int>> marked;
  marked.reserve(answer.faces.size());
  for (std::size_t f = 0; f < answer.faces.size(); ++f)
    marked.emplace_back(sorted(answer.faces[f]), answer.marker[f]);
  std::sort(marked.begin(), marked.end());
  std::vector<int> result;
  result.reserve(mesh.faces.size());
  auto at = marked.begin();
  for (const Triangle& face : mesh.faces) {
    const Triangle wanted = sorted(face);
    while (at != marked.end() && at->first < wanted) ++at;
    result.push_back(at != marked.end() && at->first == wanted ? at->second : 0);
  }
  return result;
}

TetgenResult finished(TetgenAnswer& answer) {
  TetgenResult result;
  TetMesh& mesh = result.mesh;
  mesh.nodes = std::move(answer.nodes);
  mesh.tets = std::move(answer.tets);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (tet_volume(mesh, t) < 0) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
  mesh.region.assign(mesh.tets.size(), 0);
  mesh.fixed.assign(mesh.nodes.size(), 0);
  mesh.faces = boundary_faces(mesh);
  result.face_marker = markers_of(mesh, answer);
  return result;
}

// TetGen takes triangles that meet at more than 179.9 degrees for one plane facet, whose diagonals
// it may draw anew: what that can change of the volume [m^3]. Of two triangles it is the
// tetrahedron of their four corners; a facet of more changes by no more than a few of these.
double redrawn_volume(const Surface& surface) {
  constexpr double kDegree = 3.14159265358979 / 180;
  const double least_cosine = std::cos(0.1 * kDegree);
  constexpr double kPairs = 3;                 // a facet of several triangles
  std::map<std::pair<int, int>, int> face_of;  // by directed edge
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      face_of[{surface.faces[f][k], surface.faces[f][(k + 1) % 3]}] = static_cast<int>(f);
  double sum = 0;
  for (const auto& [edge, face] : face_of) {
    if (edge.first > edge.second) continue;
    const auto beside = face_of.find({edge.second, edge.first});
    if (beside == face_of.end()) continue;
    const Vec3 here = face_normal(surface, face), there = face_normal(surface, beside->second);
    if (here.dot(there) < least_cosine * here.norm() * there.norm()) continue;
    const Triangle& other = surface.faces[static_cast<std::size_t>(beside->second)];
    for (const int corner : other)
      if (corner != edge.first && corner != edge.second)
        sum += std::abs(here.dot(surface.vertices[static_cast<std::size_t>(corner)] -
                                 surface.vertices[static_cast<std::size_t>(edge.first)])) /
               6;
  }
  return kPairs * sum;
}

// TetGen also fails on parts of the surface that nearly touch: the vertex that lies nearest to a
// triangle it is no corner of, over that triangle's size. Empty when nothing comes close.
std::string closest_parts(const Surface& surface) {
  const SurfaceTree tree(surface);
  double least = 1e-3;  // gap over edge length
  std::string text;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const Vec3& p = surface.vertices[v];
    const SurfacePoint near = tree.nearest_apart(p, static_cast<int>(v));
    if (near.face < 0) continue;
    const double edge = std::sqrt(face_normal(surface, near.face).norm());
    if (!(near.distance < least * edge)) continue;
    least = near.distance / edge;
    text =
        fmt::format("; vertex {} at ({:.6g}, {:.6g}, {:.6g}) comes within {:.2g} m of triangle {}",
                    v, p.x(), p.y(), p.z(), near.distance, near.face);
  }
  return text;
}

}  // namespace

TetgenResult run_tetgen(const TetgenInput& input, const TetgenOptions& options,
                        const std::string& where) {
  check_surface(input.surface, where);
  TetgenAnswer answer = run_tetgen_child(input, options);
  std::string failure = answer.failure;
  TetgenResult result;
  if (failure.empty()) {
    result = finished(answer);
    const double inside = signed_volume(input.surface), filled = volume(result.mesh);
    const double off = std::abs(filled - inside);
    if (!(off < 1e-6 * inside ||
          off < 1e-6 * inside + std::min(redrawn_volume(input.surface), 1e-3 * inside)))
      failure = fmt::format("TetGen filled {:.6g} of {:.6g} m^3", filled, inside);
    for (std::size_t t = 0; t < result.mesh.tets.size() && failure.empty(); ++t)
      if (!(tet_volume(result.mesh, t) > least_volume(result.mesh, t)))
        failure = "TetGen left a flat tetrahedron";
  }
  if (!failure.empty()) {
    check_self_intersection(input.surface, where);  // a better message when that is the cause
    fail_input(where, failure + closest_parts(input.surface), kMend);
  }
  return result;
}

}  // namespace hapsim
