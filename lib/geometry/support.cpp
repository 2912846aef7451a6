#include "geometry/support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/error.h"
#include "io/csv.h"

namespace hapsim {

Support parse_support(const std::string& text) {
  if (text == "bottom") return {};
  if (text == "none") return {SupportKind::kNone};
  const std::size_t split = text.find_first_of(":= ");
  const std::string kind = text.substr(0, split);
  Support support{kind == "plane" ? SupportKind::kPlane : SupportKind::kBelow};
  if ((kind != "plane" && kind != "below") || split == std::string::npos ||
      !parse_number(text.substr(split + 1), support.z))
    fail_usage("'" + text + "' names no support",
               "give bottom, plane:Z, below:Z or none, Z in metres");
  return support;
}

std::vector<std::uint8_t> bonded_faces(const std::vector<Vec3>& nodes,
                                       const std::vector<Triangle>& faces, const Support& support) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Triangle& f : faces)
    for (const int n : f) {
      low = std::min(low, nodes[n].z());
      high = std::max(high, nodes[n].z());
    }
  const double tolerance = support.tolerance > 0 ? support.tolerance : 0.005 * (high - low);
  const auto bonded = [&](int n) {
    switch (support.kind) {
      case SupportKind::kBottom:
        return nodes[n].z() - low <= tolerance;
      case SupportKind::kPlane:
        return std::abs(nodes[n].z() - support.z) <= tolerance;
      case SupportKind::kBelow:
        return nodes[n].z() <= support.z;
      case SupportKind::kNone:
        break;
    }
    return false;
  };
  std::vector<std::uint8_t> result;
  for (const Triangle& f : faces) result.push_back(bonded(f[0]) && bonded(f[1]) && bonded(f[2]));
  return result;
}

std::vector<int> nodes_of_faces(const TetMesh& mesh, const std::vector<std::uint8_t>& chosen) {
  std::set<std::pair<int, int>> edges;
  std::set<int> nodes;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!chosen[f]) continue;
    for (int k = 0; k < 3; ++k) {
      nodes.insert(mesh.faces[f][k]);
      edges.insert(std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]));
    }
  }
  if (mesh.order == 2)
    for (const auto& t : mesh.tets)
      for (int e = 0; e < 6; ++e)
        if (edges.count(std::minmax(t[kTetEdges[e][0]], t[kTetEdges[e][1]])) > 0)
          nodes.insert(t[4 + e]);
  return {nodes.begin(), nodes.end()};
}

int fix_faces(TetMesh& mesh, const std::vector<std::uint8_t>& bonded) {
  mesh.fixed.assign(mesh.nodes.size(), 0);
  const std::vector<int> nodes = nodes_of_faces(mesh, bonded);
  for (const int n : nodes) mesh.fixed[n] = 1;
  return static_cast<int>(nodes.size());
}

int fix_bottom(TetMesh& mesh) {
  return fix_faces(mesh, bonded_faces(mesh.nodes, mesh.faces, Support{}));
}

}  // namespace hapsim
