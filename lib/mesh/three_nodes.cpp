#include "mesh/three_nodes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace hapsim {

ThreeNodes::ThreeNodes(const Surface& surface) {
  std::vector<Vec3> normal(surface.vertices.size(), Vec3::Zero());
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    for (const int v : surface.faces[f]) normal[v] += face_normal(surface, static_cast<int>(f));
  for (std::size_t v = 0; v < normal.size(); ++v)
    if (normal[v].norm() > 0)
      sorted_.push_back({surface.vertices[v], normal[v].normalized(), static_cast<int>(v)});
  axis_.resize(sorted_.size());
  build(0, static_cast<int>(sorted_.size()));
}

void ThreeNodes::build(int first, int end) {
  if (first >= end) return;
  Vec3 low = sorted_[first].point, high = low;
  for (int i = first; i < end; ++i) {
    low = low.cwiseMin(sorted_[i].point);
    high = high.cwiseMax(sorted_[i].point);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = (first + end) / 2;
  const auto begin = sorted_.begin();
  std::nth_element(begin + first, begin + middle, begin + end,
                   [axis](const Node& a, const Node& b) {
                     return std::pair(a.point[axis], a.number) < std::pair(b.point[axis], b.number);
                   });
  axis_[middle] = static_cast<std::uint8_t>(axis);
  build(first, middle);
  build(middle + 1, end);
}

int ThreeNodes::nearest(const Vec3& p, Found (&found)[kCandidates]) const noexcept {
  struct Range {
    int first, end;
    double distance;  // squared, of the range's side of its parent's plane
  };
  Range open[64];
  int count = 0, have = 0;
  open[count++] = {0, static_cast<int>(sorted_.size()), 0};
  while (count > 0) {
    const Range range = open[--count];
    if (range.first >= range.end) continue;
    if (have == kCandidates && range.distance >= found[have - 1].distance) continue;
    const int middle = (range.first + range.end) / 2;
    const double d = (sorted_[middle].point - p).squaredNorm();
    if (have < kCandidates || d < found[have - 1].distance) {
      int i = have < kCandidates ? have++ : have - 1;
      for (; i > 0 && found[i - 1].distance > d; --i) found[i] = found[i - 1];
      found[i] = {d, middle};
    }
    const double over = p[axis_[middle]] - sorted_[middle].point[axis_[middle]];
    const Range below{range.first, middle, over > 0 ? over * over : range.distance};
    const Range above{middle + 1, range.end, over > 0 ? range.distance : over * over};
    open[count++] = over > 0 ? below : above;  // the nearer side is looked at first
    open[count++] = over > 0 ? above : below;
  }
  return have;
}

NodePlane ThreeNodes::at(const Vec3& tool, const Vec3& velocity) const noexcept {
  NodePlane plane;
  Found found[kCandidates];
  const int have = nearest(tool, found);
  if (have < 3) return plane;
  const Node &a = sorted_[found[0].at], &b = sorted_[found[1].at];
  for (int k = 2; k < have; ++k) {
    const Node& c = sorted_[found[k].at];
    const Vec3 u = b.point - a.point, v = c.point - a.point;
    const Vec3 n = u.cross(v);
    if (!(n.norm() > 1e-3 * u.norm() * v.norm())) continue;
    plane.node[0] = a.number;
    plane.node[1] = b.number;
    plane.node[2] = c.number;
    plane.normal = n.normalized();
    const double along =
        velocity.squaredNorm() > 0 ? -plane.normal.dot(velocity) : plane.normal.dot(a.normal);
    if (along < 0) plane.normal = -plane.normal;
    plane.distance = plane.normal.dot(tool - a.point);
    plane.contact = plane.distance <= 0;
    break;
  }
  return plane;
}

}  // namespace hapsim
