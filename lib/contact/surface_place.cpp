#include "contact/surface_place.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "mesh/surface_tree.h"

namespace hapsim {
namespace {

using Weights6 = std::array<double, 6>;

// Quadratic shape functions of a triangle at its coordinates (a, b), and their derivatives.
Weights6 triangle_shape(double a, double b) {
  const double c = 1 - a - b;
  return {c * (2 * c - 1), a * (2 * a - 1), b * (2 * b - 1), 4 * c * a, 4 * a * b, 4 * b * c};
}
Weights6 shape_by_a(double a, double b) {
  const double c = 1 - a - b;
  return {1 - 4 * c, 4 * a - 1, 0, 4 * (c - a), 4 * b, -4 * b};
}
Weights6 shape_by_b(double a, double b) {
  const double c = 1 - a - b;
  return {1 - 4 * c, 0, 4 * b - 1, -4 * a, 4 * a, 4 * (c - b)};
}

Vec3 mapped(const TetMesh& mesh, const std::array<int, 6>& node, const Weights6& weight) {
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 6; ++k)
    x += weight[k] * mesh.nodes[static_cast<std::size_t>(node[k])];
  return x;
}

// Coordinates of the face's point nearest to p: Gauss-Newton steps within the triangle, halved
// where they lead away.
Eigen::Vector2d coordinates_of(const TetMesh& mesh, const std::array<int, 6>& node, const Vec3& p) {
  const auto clamped = [](Eigen::Vector2d at) {
    at = at.cwiseMax(0);
    if (const double sum = at.sum(); sum > 1) at /= sum;
    return at;
  };
  const auto off = [&](const Eigen::Vector2d& at) {
    return Vec3(mapped(mesh, node, triangle_shape(at[0], at[1])) - p);
  };
  const auto corner = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(node[k])]; };
  Eigen::Matrix<double, 3, 2> edges;
  edges << corner(1) - corner(0), corner(2) - corner(0);
  Eigen::Vector2d at = clamped(edges.colPivHouseholderQr().solve(p - corner(0)));
  for (int step = 0; step < 30; ++step) {
    Eigen::Matrix<double, 3, 2> slope;
    slope << mapped(mesh, node, shape_by_a(at[0], at[1])),
        mapped(mesh, node, shape_by_b(at[0], at[1]));
    const Vec3 now = off(at);
    Eigen::Vector2d move = -slope.colPivHouseholderQr().solve(now);
    Eigen::Vector2d next = clamped(at + move);
    for (int half = 0; half < 8 && off(next).norm() > now.norm(); ++half)
      next = clamped(at + (move /= 2));
    if (off(next).norm() >= now.norm()) break;
    at = next;
  }
  return at;
}

}  // namespace

std::vector<SurfacePlace> surface_places(const TetMesh& mesh, const std::vector<Vec3>& points) {
  assert(mesh.order == 2);
  std::vector<int> of_vertex;
  const Surface boundary = boundary_surface(mesh, &of_vertex);
  std::map<std::pair<int, int>, int> middle;
  for (const auto& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e) {
      const int i = tet[static_cast<std::size_t>(kTetEdges[e][0])];
      const int j = tet[static_cast<std::size_t>(kTetEdges[e][1])];
      middle[std::minmax(i, j)] = tet[4 + e];
    }
  const SurfaceTree tree(boundary);
  std::vector<SurfacePlace> places;
  for (const Vec3& p : points) {
    const Triangle& face = boundary.faces[static_cast<std::size_t>(tree.nearest(p).face)];
    SurfacePlace place{};
    for (std::size_t k = 0; k < 3; ++k)
      place.node[k] = of_vertex[static_cast<std::size_t>(face[k])];
    for (std::size_t k = 0; k < 3; ++k)
      place.node[3 + k] = middle.at(std::minmax(place.node[k], place.node[(k + 1) % 3]));
    const Eigen::Vector2d at = coordinates_of(mesh, place.node, p);
    place.weight = triangle_shape(at[0], at[1]);
    places.push_back(place);
  }
  return places;
}

}  // namespace hapsim
