// How a body's whole surface yields to forces on it: the inverse stiffness condensed to the
// surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "linalg/schur_inverse.h"
#include "solid/elasticity.h"
#include "solid/node_system.h"

namespace hapsim {

// Nodes of the boundary faces, ascending; of second order with the middles of their edges.
std::vector<int> surface_nodes(const TetMesh& mesh);

enum class SurfaceNodes { kAll, kCorners };

// A linear elastic body held at its fixed nodes, free elsewhere. One factorisation gives the
// displacement of every free surface node for a force on every other, u_s = C f_s.
class SurfaceCompliance {
 public:
  // The mesh must outlive it. Cost: the analysis of the sparsity, once. Error(kBadInput) when all
  // its nodes are fixed.
  // `kept`: kCorners leaves the middles of edges free and out of nodes().
  explicit SurfaceCompliance(const TetMesh& mesh, Dilatation dilatation = Dilatation::kPointwise)
      : SurfaceCompliance(mesh, dilatation, SurfaceNodes::kAll) {}
  SurfaceCompliance(const TetMesh& mesh, Dilatation dilatation, SurfaceNodes kept);

  // Assembles and condenses for one pair of Lame's constants an element [Pa]; no new analysis.
  // `threads` of the dense part (one such call at a time where it is not 1).
  // Error(kNoConvergence) when the stiffness is not positive definite (body not held, nu >= 0.5).
  void factorise(const std::vector<Lame>& lame_of_tet, int threads = 1);
  // A body whose moduli are all `factor` times what they were: no factorisation.
  void scale_modulus(double factor);

  // The free surface nodes, ascending; node k owns rows 3 k .. 3 k + 2.
  const std::vector<int>& nodes() const { return nodes_; }
  // Place of a mesh node in nodes(), -1: held or inside.
  int index_of(int node) const { return index_[static_cast<std::size_t>(node)]; }
  const Eigen::MatrixXd& matrix() const { return matrix_; }  // 3 n x 3 n, symmetric [m/N]
  // Displacement of the a-th surface node for a force on the b-th [m/N].
  Eigen::Matrix3d block(int a, int b) const { return matrix_.block<3, 3>(3 * a, 3 * b); }
  // Stiffness of the nodes `patch` (places in nodes()) that translate together, all others free:
  // the bonded flat tool [N/m]. Cost: a dense factorisation of the patch.
  Eigen::Matrix3d patch_stiffness(const std::vector<int>& patch) const;

  int unknowns() const { return system_.unknowns(); }
  const SymmetricSparse& stiffness() const { return system_.matrix(); }  // of all free nodes [N/m]

 private:
  const TetMesh& mesh_;
  Dilatation dilatation_;
  NodeSystem system_;
  std::vector<int> nodes_, index_;
  SchurInverse schur_;
  Eigen::MatrixXd matrix_;
};

}  // namespace hapsim
