// Nearest points of a surface for many queries.
#pragma once

#include <vector>

#include "geometry/surface.h"

namespace hapsim {

// The point of the triangle a, b, c nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// A tree of bounding boxes over the faces: nearest_point() in O(log faces). Keeps a copy of the
// surface; queries are thread-safe.
class SurfaceTree {
 public:
  explicit SurfaceTree(Surface surface);
  const Surface& surface() const { return surface_; }
  // face -1 and infinite distance when the surface has no face.
  SurfacePoint nearest(const Vec3& p) const;

 private:
  struct Node {
    Vec3 low, high;
    int first = 0, count = 0;  // leaf: faces order_[first, first + count)
    int right = -1;            // inner: left child follows, right child's index
  };
  int build(int first, int count);
  void search(int node, const Vec3& p, SurfacePoint& best) const;

  Surface surface_;
  std::vector<int> order_;
  std::vector<Vec3> centre_;
  std::vector<Node> nodes_;
};

}  // namespace hapsim
