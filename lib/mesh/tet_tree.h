// Which tetrahedron of a body holds a point, for many queries.
#pragma once

#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// A tree of bounding boxes over the tetrahedra, straight between their corners. Keeps what it needs
// of the mesh; queries allocate nothing and are thread-safe.
class TetTree {
 public:
  explicit TetTree(const TetMesh& mesh);
  // The tetrahedron that holds p, on whose faces it may lie; -1 outside of all.
  int find(const Vec3& p) const;

 private:
  struct Node {
    Vec3 low, high;
    int first = 0, count = 0;  // leaf: order_[first, first + count)
    int right = -1;            // inner: left child follows, right child's index
  };
  int build(const std::vector<Vec3>& centre, int first, int count);

  std::vector<std::array<Vec3, 4>> corners_;  // by tetrahedron
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace hapsim
