#include "mesh/surface_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace hapsim {
namespace {

constexpr int kLeafFaces = 4;
// Halving reaches a leaf in fewer steps than an int has bits; each leaves one sibling behind.
constexpr int kDeepest = 40;

double squared_distance(const Vec3& p, const Vec3& low, const Vec3& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

}  // namespace

Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  TriangleFeature feature;
  return nearest_in_triangle(p, a, b, c, feature);
}

Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                         TriangleFeature& feature) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  feature = TriangleFeature::kCorner0;
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  feature = TriangleFeature::kCorner1;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  feature = TriangleFeature::kEdge01;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 == d3 ? 0 : d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  feature = TriangleFeature::kCorner2;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  feature = TriangleFeature::kEdge20;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 == d6 ? 0 : d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  const double along = d4 - d3;
  const double across = d5 - d6;
  feature = TriangleFeature::kEdge12;
  if (va <= 0 && along >= 0 && across >= 0) {
    return b + (c - b) * (along + across == 0 ? 0 : along / (along + across));
  }
  feature = TriangleFeature::kInside;
  const double scale = 1 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

SurfaceTree::SurfaceTree(Surface surface) : surface_(std::move(surface)) {
  const int faces = static_cast<int>(surface_.faces.size());
  if (faces == 0) return;
  std::vector<int> order(faces);
  std::iota(order.begin(), order.end(), 0);
  std::vector<Vec3> centre;
  centre.reserve(faces);
  for (const Triangle& f : surface_.faces) {
    centre.push_back((surface_.vertices[f[0]] + surface_.vertices[f[1]] + surface_.vertices[f[2]]) /
                     3);
  }
  build(order, centre, 0, faces);
  packed_.reserve(faces);
  for (const int f : order) {
    const Triangle& t = surface_.faces[f];
    const Vec3 &a = surface_.vertices[t[0]], &b = surface_.vertices[t[1]],
               &c = surface_.vertices[t[2]];
    const double reach =
        std::max({(a - centre[f]).norm(), (b - centre[f]).norm(), (c - centre[f]).norm()});
    packed_.push_back({centre[f], reach * (1 + 1e-9), {a, b, c}, f});
  }
}

int SurfaceTree::build(std::vector<int>& order, const std::vector<Vec3>& centre, int first,
                       int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(kInfinity);
  Vec3 high = -low;
  for (int i = first; i < first + count; ++i) {
    for (const int v : surface_.faces[order[i]]) {
      low = low.cwiseMin(surface_.vertices[v]);
      high = high.cwiseMax(surface_.vertices[v]);
    }
  }
  nodes_[index].low = low;
  nodes_[index].high = high;
  if (count <= kLeafFaces) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = order.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    return std::pair(centre[a][axis], a) < std::pair(centre[b][axis], b);
  });
  build(order, centre, first, half);
  const int right = build(order, centre, first + half, count - half);
  nodes_[index].right = right;
  return index;
}

// best.distance is squared in here.
void SurfaceTree::search(const Vec3& p, int apart, SurfacePoint& best) const {
  struct Open {
    int node;
    double distance;
  };
  Open open[kDeepest];
  int count = 0;
  open[count++] = {0, squared_distance(p, nodes_[0].low, nodes_[0].high)};
  double root = std::sqrt(best.distance);
  while (count > 0) {
    const Open next = open[--count];
    if (next.distance >= best.distance) continue;
    int at = next.node;
    while (nodes_[at].right >= 0) {
      int near = at + 1;
      int far = nodes_[at].right;
      double near_distance = squared_distance(p, nodes_[near].low, nodes_[near].high);
      double far_distance = squared_distance(p, nodes_[far].low, nodes_[far].high);
      if (far_distance < near_distance) {
        std::swap(near, far);
        std::swap(near_distance, far_distance);
      }
      if (far_distance < best.distance) open[count++] = {far, far_distance};
      if (near_distance >= best.distance) break;
      at = near;
    }
    const Node& n = nodes_[at];
    if (n.right >= 0) continue;
    for (int i = n.first; i < n.first + n.count; ++i) {
      const Packed& t = packed_[i];
      const double reach = root + t.radius;
      if ((p - t.centre).squaredNorm() > reach * reach) continue;
      const Vec3 q = nearest_in_triangle(p, t.corner[0], t.corner[1], t.corner[2]);
      const double distance = (q - p).squaredNorm();
      if (distance >= best.distance) continue;
      if (apart >= 0) {
        const Triangle& f = surface_.faces[t.face];
        if (f[0] == apart || f[1] == apart || f[2] == apart) continue;
      }
      best = {q, t.face, distance};
      root = std::sqrt(distance);
    }
  }
}

SurfacePoint SurfaceTree::nearest(const Vec3& p, int hint) const {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return best;
  if (hint >= 0 && hint < static_cast<int>(surface_.faces.size())) {
    const Triangle& t = surface_.faces[hint];
    const Vec3 q = nearest_in_triangle(p, surface_.vertices[t[0]], surface_.vertices[t[1]],
                                       surface_.vertices[t[2]]);
    best = {q, hint, (q - p).squaredNorm()};
  }
  search(p, -1, best);
  best.distance = std::sqrt(best.distance);
  return best;
}

SurfacePoint SurfaceTree::nearest_apart(const Vec3& p, int vertex) const {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return best;
  search(p, vertex, best);
  best.distance = std::sqrt(best.distance);
  return best;
}

}  // namespace hapsim
