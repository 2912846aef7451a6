#include "mesh/tetmesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mesh/tet_faces.h"

namespace hapsim {
namespace {

using EdgeKey = std::uint64_t;

EdgeKey edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<EdgeKey>(low) << 32 | static_cast<EdgeKey>(high);
}

}  // namespace

double tet_volume(const TetMesh& mesh, std::size_t tet) {
  const auto& t = mesh.tets[tet];
  const Vec3& origin = mesh.nodes[t[0]];
  return (mesh.nodes[t[1]] - origin)
             .cross(mesh.nodes[t[2]] - origin)
             .dot(mesh.nodes[t[3]] - origin) /
         6;
}

double least_volume(const TetMesh& mesh, std::size_t tet) {
  constexpr double kFlat = 1e-12;  // over the cube of the longest edge; a regular one has 0.12
  const auto& t = mesh.tets[tet];
  double longest = 0;
  for (const auto& edge : kTetEdges)
    longest = std::max(longest, (mesh.nodes[t[edge[0]]] - mesh.nodes[t[edge[1]]]).norm());
  return kFlat * longest * longest * longest;
}

Vec3 tet_centroid(const TetMesh& mesh, std::size_t tet) {
  const auto& n = mesh.tets[tet];
  return (mesh.nodes[n[0]] + mesh.nodes[n[1]] + mesh.nodes[n[2]] + mesh.nodes[n[3]]) / 4;
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) sum += tet_volume(mesh, t);
  return sum;
}

std::vector<Triangle> boundary_faces(const TetMesh& mesh) {
  std::vector<Triangle> faces;
  visit_faces(mesh, [&](std::size_t tet, int face, int tets) {
    if (tets == 1) faces.push_back(face_of(mesh, tet, face));
  });
  return faces;
}

TetMesh to_second_order(const TetMesh& mesh) {
  if (mesh.order == 2) return mesh;
  TetMesh result = mesh;
  result.order = 2;
  // Edges in order of their corners, so the numbering does not depend on that of the tetrahedra.
  std::vector<EdgeKey> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const auto& t : mesh.tets)
    for (const auto& corner : kTetEdges) edges.push_back(edge_key(t[corner[0]], t[corner[1]]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const int corners = static_cast<int>(mesh.nodes.size());
  const auto middle = [&](int a, int b) {
    const auto found = std::lower_bound(edges.begin(), edges.end(), edge_key(a, b));
    return corners + static_cast<int>(found - edges.begin());
  };

  result.nodes.reserve(mesh.nodes.size() + edges.size());
  for (const EdgeKey edge : edges)
    result.nodes.push_back(0.5 * (mesh.nodes[edge >> 32] + mesh.nodes[edge & 0xffffffffu]));
  for (auto& t : result.tets)
    for (int e = 0; e < 6; ++e) t[4 + e] = middle(t[kTetEdges[e][0]], t[kTetEdges[e][1]]);
  result.fixed.resize(result.nodes.size(), 0);
  for (const Triangle& f : mesh.faces) {
    if (!mesh.fixed[f[0]] || !mesh.fixed[f[1]] || !mesh.fixed[f[2]]) continue;
    for (int i = 0; i < 3; ++i) result.fixed[middle(f[i], f[(i + 1) % 3])] = 1;
  }
  return result;
}

Surface boundary_surface(const TetMesh& mesh, std::vector<int>* node) {
  std::vector<int> vertex(mesh.nodes.size(), -1);
  for (const Triangle& f : mesh.faces)
    for (const int n : f) vertex[n] = 0;
  Surface surface;
  if (node != nullptr) node->clear();
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (vertex[n] < 0) continue;
    vertex[n] = static_cast<int>(surface.vertices.size());
    surface.vertices.push_back(mesh.nodes[n]);
    if (node != nullptr) node->push_back(static_cast<int>(n));
  }
  for (const Triangle& f : mesh.faces)
    surface.faces.push_back({vertex[f[0]], vertex[f[1]], vertex[f[2]]});
  return surface;
}

}  // namespace hapsim
