// Sums over the part of a mesh that lies inside a boundary, without visiting all of the mesh.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/tetmesh.h"
#include "solid/level_set.h"

namespace hapsim {

// Symmetric matrices, one a tetrahedron, in a tree of bounding balls with their sums: what lies
// wholly on one side of a boundary is taken or left as a whole, so that the cost follows the
// boundary's area.
class ShareTree {
 public:
  ShareTree() = default;
  // The mesh must outlive the tree.
  ShareTree(const TetMesh& mesh, const std::vector<Eigen::Matrix3d>& share);

  struct Inside {
    Eigen::Matrix3d share;
    std::vector<Eigen::Matrix3d> by_parameters;  // the boundary's
  };
  // Elements that the boundary cuts count by the share of their volume (inside_share). The level
  // set's `clear` decides what is on one side.
  Inside inside(const LevelSet& level, std::size_t parameters) const;
  std::size_t held_bytes() const {  // the mesh without
    return hapsim::held_bytes(share_) + hapsim::held_bytes(order_) + hapsim::held_bytes(nodes_);
  }

 private:
  struct Node {
    Vec3 centre = Vec3::Zero();
    double reach = 0;  // every corner below is so near to the centre [m]
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    std::size_t first = 0, last = 0;  // of order_
    std::size_t right = 0;            // the left child is the next node; 0: a leaf
  };
  std::size_t build(std::size_t first, std::size_t last, const std::vector<Vec3>& centre);

  const TetMesh* mesh_ = nullptr;
  std::vector<Eigen::Matrix3d> share_;
  std::vector<std::size_t> order_;  // of the tetrahedra
  std::vector<Node> nodes_;         // the root first
};

}  // namespace hapsim
