#include "tetmesh/curve_edges.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "mesh/surface_tree.h"
#include "mesh/tet_faces.h"

namespace hapsim {
namespace {

constexpr double kFarthest = 0.25;      // of an edge length
constexpr double kLeastJacobian = 0.1;  // of the straight tetrahedron's

// Determinant of the quadratic map of a tetrahedron at barycentric coordinates l.
double jacobian(const TetMesh& mesh, const std::array<int, 10>& t, const std::array<double, 4>& l) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  // d N / d l, with l0 = 1 - l1 - l2 - l3.
  std::array<double, 10> d;
  for (int axis = 1; axis < 4; ++axis) {
    const auto by = [&](int corner) { return corner == axis ? 1.0 : corner == 0 ? -1.0 : 0.0; };
    for (int c = 0; c < 4; ++c) d[c] = (4 * l[c] - 1) * by(c);
    for (int e = 0; e < 6; ++e) {
      const int a = kTetEdges[e][0], b = kTetEdges[e][1];
      d[4 + e] = 4 * (by(a) * l[b] + by(b) * l[a]);
    }
    for (int n = 0; n < 10; ++n) J.col(axis - 1) += d[n] * mesh.nodes[t[n]];
  }
  return J.determinant();
}

double least_jacobian(const TetMesh& mesh, const std::array<int, 10>& t) {
  double least = jacobian(mesh, t, {0.25, 0.25, 0.25, 0.25});
  for (int c = 0; c < 4; ++c) {
    std::array<double, 4> l{};
    l[c] = 1;
    least = std::min(least, jacobian(mesh, t, l));
  }
  for (const auto& edge : kTetEdges) {
    std::array<double, 4> l{};
    l[edge[0]] = l[edge[1]] = 0.5;
    least = std::min(least, jacobian(mesh, t, l));
  }
  return least;
}

}  // namespace

CurvedEdges curve_edges(TetMesh& mesh, const Surface& smooth) {
  CurvedEdges result;
  if (mesh.order != 2 || smooth.faces.empty()) return result;
  // The boundary's nodes with the shortest edge they belong to.
  std::vector<double> edge(mesh.nodes.size(), 0);
  const auto note = [&](int n, double length) {
    edge[n] = edge[n] == 0 ? length : std::min(edge[n], length);
  };
  visit_faces(mesh, [&](std::size_t tet, int face, int tets) {
    if (tets != 1) return;
    const auto& t = mesh.tets[tet];
    for (int e = 0; e < 6; ++e) {
      const int a = kTetEdges[e][0], b = kTetEdges[e][1];
      const auto& f = kFaceCorners[face];
      if (std::find(f, f + 3, a) == f + 3 || std::find(f, f + 3, b) == f + 3) continue;
      const double length = (mesh.nodes[t[a]] - mesh.nodes[t[b]]).norm();
      for (const int n : {t[a], t[b], t[4 + e]}) note(n, length);
    }
  });
  const std::vector<Vec3> straight = mesh.nodes;
  const SurfaceTree tree(smooth);
  std::vector<std::uint8_t> moved(mesh.nodes.size(), 0);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (edge[n] == 0 || mesh.fixed[n] != 0) continue;
    const SurfacePoint at = tree.nearest(mesh.nodes[n]);
    if (!(at.distance <= kFarthest * edge[n])) continue;
    mesh.nodes[n] = at.point;
    moved[n] = 1;
  }
  // Middles inside follow the corners they lie between.
  const auto settle = [&] {
    for (const auto& t : mesh.tets)
      for (int e = 0; e < 6; ++e)
        if (edge[t[4 + e]] == 0)
          mesh.nodes[t[4 + e]] =
              0.5 * (mesh.nodes[t[kTetEdges[e][0]]] + mesh.nodes[t[kTetEdges[e][1]]]);
  };
  settle();
  for (bool folded = true; folded;) {
    folded = false;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto& n = mesh.tets[t];
      if (std::none_of(n.begin(), n.end(), [&](int k) { return moved[k] != 0; })) continue;
      const auto& x = straight;
      const double plain = (x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).dot(x[n[3]] - x[n[0]]);
      if (least_jacobian(mesh, n) > kLeastJacobian * plain) continue;
      for (const int k : n)
        if (moved[k] != 0) {
          moved[k] = 0;
          mesh.nodes[k] = straight[k];
          ++result.straight;
          folded = true;
        }
    }
    settle();
  }
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (moved[n] != 0) {
      ++result.moved;
      result.farthest = std::max(result.farthest, (mesh.nodes[n] - straight[n]).norm());
    }
  return result;
}

}  // namespace hapsim
