#include "geometry/surface_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace hapsim {
namespace {

constexpr int kLeafFaces = 4;

double squared_distance(const Vec3& p, const Vec3& low, const Vec3& high) {
  return (p - p.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

}  // namespace

Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 == d3 ? 0 : d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 == d6 ? 0 : d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  const double along = d4 - d3;
  const double across = d5 - d6;
  if (va <= 0 && along >= 0 && across >= 0) {
    return b + (c - b) * (along + across == 0 ? 0 : along / (along + across));
  }
  const double scale = 1 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

SurfaceTree::SurfaceTree(Surface surface) : surface_(std::move(surface)) {
  const int faces = static_cast<int>(surface_.faces.size());
  order_.resize(faces);
  std::iota(order_.begin(), order_.end(), 0);
  centre_.reserve(faces);
  for (const Triangle& f : surface_.faces) {
    centre_.push_back(
        (surface_.vertices[f[0]] + surface_.vertices[f[1]] + surface_.vertices[f[2]]) / 3);
  }
  if (faces > 0) build(0, faces);
}

int SurfaceTree::build(int first, int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(kInfinity);
  Vec3 high = -low;
  for (int i = first; i < first + count; ++i) {
    for (const int v : surface_.faces[order_[i]]) {
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
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    return std::pair(centre_[a][axis], a) < std::pair(centre_[b][axis], b);
  });
  build(first, half);
  const int right = build(first + half, count - half);
  nodes_[index].right = right;
  return index;
}

void SurfaceTree::search(int node, const Vec3& p, SurfacePoint& best) const {
  const Node& n = nodes_[node];
  if (n.right < 0) {
    for (int i = n.first; i < n.first + n.count; ++i) {
      const Triangle& t = surface_.faces[order_[i]];
      const Vec3 q = nearest_in_triangle(p, surface_.vertices[t[0]], surface_.vertices[t[1]],
                                         surface_.vertices[t[2]]);
      const double distance = (q - p).norm();
      if (distance < best.distance) best = {q, order_[i], distance};
    }
    return;
  }
  int near = node + 1;
  int far = n.right;
  double near_distance = squared_distance(p, nodes_[near].low, nodes_[near].high);
  double far_distance = squared_distance(p, nodes_[far].low, nodes_[far].high);
  if (far_distance < near_distance) {
    std::swap(near, far);
    std::swap(near_distance, far_distance);
  }
  if (near_distance < best.distance * best.distance) search(near, p, best);
  if (far_distance < best.distance * best.distance) search(far, p, best);
}

SurfacePoint SurfaceTree::nearest(const Vec3& p) const {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) search(0, p, best);
  return best;
}

}  // namespace hapsim
