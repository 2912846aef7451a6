#include "mesh/signed_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/surface_check.h"

namespace hapsim {
namespace {

Surface checked(Surface surface, const std::string& where) {
  check_surface(surface, where);
  return surface;
}

double angle_at(const Vec3& corner, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - corner, v = b - corner;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

// Edges by their ends, each with the face and edge number it is of.
struct Side {
  int low, high, face, edge;
  bool operator<(const Side& other) const {
    return std::pair(low, high) < std::pair(other.low, other.high);
  }
};

}  // namespace

SignedDistance::SignedDistance(Surface surface, const std::string& where)
    : tree_(checked(std::move(surface), where)) {
  const Surface& s = tree_.surface();
  const int faces = static_cast<int>(s.faces.size());
  vertex_normal_.assign(s.vertices.size(), Vec3::Zero());
  first_around_.assign(s.vertices.size() + 1, 0);
  std::vector<Side> sides;
  sides.reserve(3 * s.faces.size());
  for (int f = 0; f < faces; ++f) {
    const Triangle& t = s.faces[f];
    face_normal_.push_back(hapsim::face_normal(s, f).normalized());
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      vertex_normal_[a] += angle_at(s.vertices[a], s.vertices[b], s.vertices[c]) * face_normal_[f];
      ++first_around_[a + 1];
      sides.push_back({std::min(a, b), std::max(a, b), f, k});
    }
  }
  for (Vec3& n : vertex_normal_) n = n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero());
  for (std::size_t v = 0; v < s.vertices.size(); ++v) first_around_[v + 1] += first_around_[v];
  around_.resize(3 * s.faces.size());
  std::vector<int> next(first_around_.begin(), first_around_.end() - 1);
  for (int f = 0; f < faces; ++f)
    for (const int v : s.faces[f]) around_[next[v]++] = f;

  std::sort(sides.begin(), sides.end());
  edge_normal_.resize(s.faces.size());
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {  // closed: every edge is there twice
    const Vec3 n = (face_normal_[sides[i].face] + face_normal_[sides[i + 1].face]).normalized();
    edge_normal_[sides[i].face][sides[i].edge] = n;
    edge_normal_[sides[i + 1].face][sides[i + 1].edge] = n;
  }
}

SurfaceSide SignedDistance::side(const Vec3& p, int face) const noexcept {
  const Surface& s = tree_.surface();
  const Triangle& t = s.faces[face];
  TriangleFeature feature;
  SurfaceSide result;
  result.point =
      nearest_in_triangle(p, s.vertices[t[0]], s.vertices[t[1]], s.vertices[t[2]], feature);
  result.face = face;
  const auto number = static_cast<std::size_t>(feature);
  if (feature == TriangleFeature::kInside)
    result.normal = face_normal_[face];
  else if (feature >= TriangleFeature::kEdge01)
    result.normal = edge_normal_[face][number - 3];
  else
    result.normal = vertex_normal_[t[number]];
  const Vec3 away = p - result.point;
  result.distance = std::copysign(away.norm(), away.dot(result.normal));
  return result;
}

SurfaceSide SignedDistance::at(const Vec3& p, int hint) const noexcept {
  return side(p, tree_.nearest(p, hint).face);
}

SurfaceSide SignedDistance::along(const Vec3& p, int face) const noexcept {
  const Surface& s = tree_.surface();
  const auto squared = [&](int f) {
    const Triangle& t = s.faces[f];
    return (nearest_in_triangle(p, s.vertices[t[0]], s.vertices[t[1]], s.vertices[t[2]]) - p)
        .squaredNorm();
  };
  double best = squared(face);
  while (true) {
    int nearer = -1;
    for (const int v : s.faces[face])
      for (int i = first_around_[v]; i < first_around_[v + 1]; ++i)
        if (const double d = squared(around_[i]); d < best) {
          best = d;
          nearer = around_[i];
        }
    if (nearer < 0) return side(p, face);
    face = nearer;
  }
}

}  // namespace hapsim
