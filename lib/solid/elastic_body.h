// A linear elastic body whose nodes are free, held, or moved by rigid handles.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solid/elasticity.h"
#include "solid/node_system.h"

namespace hapsim {

// Node classes: a handle's nodes translate together (the bonded flat tool), its reaction is the
// resultant of its nodes.
constexpr int kFreeNode = -1;
constexpr int kHeldNode = -2;  // displacement zero

class ElasticBody {
 public:
  // `handle`: one a node, kFreeNode, kHeldNode or a handle's number 0..n-1. Nodes that no element
  // uses are held. The mesh must outlive the body. Cost: the analysis of the sparsity, once.
  // `dilatation`: kPointwise, or kElement, with which second order does not lock. `solver`: by size
  // means for one solve() of three columns a handle.
  ElasticBody(const TetMesh& mesh, const std::vector<int>& handle,
              Dilatation dilatation = Dilatation::kPointwise,
              SolverKind solver = SolverKind::kDirect);

  // Assembles and factorises for one pair of Lame's constants an element [Pa].
  // Error(kNoConvergence) when the stiffness is not positive definite (body not held, nu >= 0.5).
  void factorise(const std::vector<Lame>& lame_of_tet);

  struct Response {
    Eigen::MatrixXd reaction;  // 3 handles x m: force that moves the handles [N]
    Eigen::MatrixXd field;     // 3 nodes x m: displacements [m]
  };
  // For prescribed handle displacements (3 handles x m) [m]. With the identity, the reaction is the
  // body's stiffness condensed to its handles.
  Response solve(const Eigen::MatrixXd& prescribed) const;

  // Displacements (3 nodes x m) [m] by forces on the free nodes [N], the handles held.
  Eigen::MatrixXd relax(const Eigen::MatrixXd& load) const { return system_.solve(load); }

  int handles() const { return handles_; }
  int unknowns() const { return system_.unknowns(); }
  const SolverChoice& solver() const { return choice_; }
  int iterations() const { return system_.iterations(); }  // StiffnessSolver
  std::size_t held_bytes() const;                          // its factor with it, its mesh without

 private:
  bool is_touched(std::size_t tet) const;

  const TetMesh& mesh_;
  std::vector<int> handle_;
  int handles_ = 0;
  Dilatation dilatation_;
  NodeSystem system_;
  SolverChoice choice_;
  std::vector<Lame> lame_;
};

}  // namespace hapsim
