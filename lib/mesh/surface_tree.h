// Nearest points of a surface for many queries.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Where in a triangle a point lies: at corner 0-2, on the edge after corner 0-2, or inside.
enum class TriangleFeature : std::uint8_t {
  kCorner0,
  kCorner1,
  kCorner2,
  kEdge01,
  kEdge12,
  kEdge20,
  kInside
};

// The point of the triangle a, b, c nearest to p (Ericson, Real-Time Collision Detection, 5.1.5),
// and on which part of it that lies.
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                         TriangleFeature& feature);

// A tree of bounding boxes over the faces: nearest() in O(log faces). Keeps a copy of the surface;
// queries allocate nothing and are thread-safe.
class SurfaceTree {
 public:
  explicit SurfaceTree(Surface surface);
  const Surface& surface() const { return surface_; }
  // face -1 and infinite distance when the surface has no face. `hint`: a face near the answer, as
  // that of the last query of a moving point; it makes the search shorter and changes nothing else
  // (of faces equally near, any may be named).
  SurfacePoint nearest(const Vec3& p, int hint = -1) const;
  // The same among the faces that do not have `vertex` as a corner.
  SurfacePoint nearest_apart(const Vec3& p, int vertex) const;

 private:
  struct Node {
    Vec3 low, high;
    int first = 0, count = 0;  // leaf: packed_[first, first + count)
    int right = -1;            // inner: left child follows, right child's index
  };
  struct Packed {  // a face beside its neighbours in space
    Vec3 centre;
    double radius;  // about the centre, a little more than it reaches
    Vec3 corner[3];
    int face;
  };
  int build(std::vector<int>& order, const std::vector<Vec3>& centre, int first, int count);
  void search(const Vec3& p, int apart, SurfacePoint& best) const;

  Surface surface_;
  std::vector<Packed> packed_;
  std::vector<Node> nodes_;
};

}  // namespace hapsim
