// The sparse stiffness matrix over the free nodes of a mesh, filled from dense blocks of the
// elements again and again.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "linalg/stiffness_solver.h"

namespace hapsim {

// Groups of nodes that act on each other: elements, patches of elements, faces.
struct Cliques {
  std::vector<int> start{0};
  std::vector<int> node;
  void add(const std::vector<int>& nodes);
  std::size_t size() const { return start.size() - 1; }
  int count(std::size_t clique) const { return start[clique + 1] - start[clique]; }
  const int* nodes(std::size_t clique) const { return node.data() + start[clique]; }
  std::size_t held_bytes() const { return hapsim::held_bytes(start) + hapsim::held_bytes(node); }
};

class NodeSystem {
 public:
  // `free`: one a node, 1 when its three displacements are unknown. Cost: sorting the pattern and
  // one symbolic analysis (at the first factorise()).
  NodeSystem(std::vector<char> free, Cliques cliques);

  const Cliques& cliques() const { return cliques_; }
  int unknowns() const { return matrix_.size; }
  bool is_free(int node) const { return block_[static_cast<std::size_t>(node)] >= 0; }

  void clear();
  // Adds a symmetric matrix (3 nodes squared, node by node) of a clique.
  void add(std::size_t clique, const Eigen::Ref<const Eigen::MatrixXd>& dense);
  // Before the first factorise(); direct otherwise.
  void use(SolverKind kind) { kind_ = kind; }
  // For an iterative solver: the two nodes in whose middle each lies, itself twice: in none.
  void lie_between(const std::vector<std::array<int, 2>>& ends);
  // Before the first factorise(): the order() of a system of the same cliques and free nodes.
  void eliminate_in(std::vector<int> order) { order_ = std::move(order); }
  std::vector<int> order() const { return solver_ ? solver_->order() : order_; }
  // False when the matrix is not positive definite. True when nothing is free. An iterative solver
  // takes the matrix; clear() makes it anew.
  bool factorise();
  // Rows of the free nodes of `load` (3 nodes x m) solved for; rows of the others are zero.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& load) const;
  int iterations() const { return solver_ ? solver_->iterations() : 0; }  // StiffnessSolver
  const SymmetricSparse& matrix() const { return matrix_; }
  std::size_t held_bytes() const;  // its factor with it

 private:
  void build_pattern();

  Cliques cliques_;
  std::vector<int> block_;  // one a node: its block, or -1
  SymmetricSparse matrix_;
  // For each clique and pair a <= b of its nodes: the place of block (row, column) within the
  // column of blocks, -1 when one of both is not free.
  std::vector<int> place_;
  std::vector<std::size_t> place_start_;
  SolverKind kind_ = SolverKind::kDirect;
  std::vector<int> order_;
  BlockEnds ends_;
  std::unique_ptr<StiffnessSolver> solver_;
};

}  // namespace hapsim
