// Contact by the three nearest nodes: the thesis's algorithm 2.1, for comparison.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct NodePlane {
  int node[3] = {-1, -1, -1};  // nearest first
  Vec3 normal = Vec3::Zero();  // of the plane through them, unit, outward
  double distance = 0;         // of the tool from that plane: negative is contact [m]
  bool contact = false;        // distance <= 0
};

// (2.4) to (2.8) with their errata: the normal is the cross product of the nodes' edges, the
// distance n . (tool - p). Nearest nodes through a k-d tree; where the three lie on one line the
// third is the next one that does not. Queries allocate nothing and throw nothing. The distance is
// that of a plane without end: it misses edges, and errs by the curvature between the nodes; see
// SignedDistance.
class ThreeNodes {
 public:
  explicit ThreeNodes(const Surface& surface);  // copies the nodes and their outward normals
  // `velocity` zero: the side is that of the surface's normal at the nearest node; else, as in
  // (2.7), the normal that makes the greater angle with the velocity.
  NodePlane at(const Vec3& tool, const Vec3& velocity = Vec3::Zero()) const noexcept;

 private:
  static constexpr int kCandidates = 8;
  struct Found {
    double distance;  // squared
    int at;           // in sorted_
  };
  int nearest(const Vec3& p, Found (&found)[kCandidates]) const noexcept;
  void build(int first, int end);

  struct Node {
    Vec3 point, normal;
    int number;
  };
  std::vector<Node> sorted_;  // implicit k-d tree: the middle of each range splits it
  std::vector<std::uint8_t> axis_;
};

}  // namespace hapsim
