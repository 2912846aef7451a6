#include "formats/tetmesh_io.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

#include "base/error.h"
#include "containers/ply.h"
#include "formats/mesh_file.h"
#include "mesh/window.h"

namespace hapsim {
namespace {

// Of each connected part the fixed corners.
std::map<int, std::vector<int>> fixed_by_part(const TetMesh& mesh) {
  std::vector<int> above(mesh.nodes.size());
  std::iota(above.begin(), above.end(), 0);
  const auto root = [&](int n) {
    for (; above[n] != n; n = above[n]) above[n] = above[above[n]];
    return n;
  };
  for (const auto& tet : mesh.tets)
    for (int k = 1; k < 4; ++k) above[root(tet[k])] = root(tet[0]);
  std::map<int, std::vector<int>> fixed;
  for (const auto& tet : mesh.tets) fixed[root(tet[0])];
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n)
    if (const auto part = fixed.find(root(n)); mesh.fixed[n] == 1 && part != fixed.end())
      part->second.push_back(n);
  return fixed;
}

// Three corners that are not on one line hold a body.
bool hold(const TetMesh& mesh, const std::vector<int>& corners) {
  if (corners.size() < 3) return false;
  const Vec3& first = mesh.nodes[corners[0]];
  const auto far = [&](const auto& distance) {
    return *std::max_element(corners.begin(), corners.end(),
                             [&](int a, int b) { return distance(a) < distance(b); });
  };
  const Vec3 line = mesh.nodes[far([&](int n) { return (mesh.nodes[n] - first).norm(); })] - first;
  const auto off_line = [&](int n) { return (mesh.nodes[n] - first).cross(line).norm(); };
  return off_line(far(off_line)) > 1e-6 * line.squaredNorm();
}

}  // namespace

TetMesh read_body(Input& input, std::vector<Vec3>* window) {
  const std::string bytes = input.read_all();
  TetMesh mesh = parse_mesh(bytes, input.name(), false).mesh;
  if (window != nullptr) *window = window_of(ply_comments(bytes));
  if (std::find(mesh.fixed.begin(), mesh.fixed.end(), 1) == mesh.fixed.end())
    fail_input(input.name(), "no node is fixed: the body would float",
               "mesh with hs-tetmesh --fixed bottom, or set the vertex property 'fixed'");
  for (const auto& [part, fixed] : fixed_by_part(mesh)) {
    if (hold(mesh, fixed)) continue;
    const Vec3& p = mesh.nodes[part];
    fail_input(input.name(),
               fmt::format("the fixed nodes do not hold the part of the body with the node at "
                           "({:.6g}, {:.6g}, {:.6g})",
                           p.x(), p.y(), p.z()),
               "fix three corners or more that are not on one line, or remove the part");
  }
  return mesh;
}

}  // namespace hapsim
