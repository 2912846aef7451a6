// Direct or iterative, by size: one face for both.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "linalg/conjugate_gradients.h"
#include "linalg/sparse_cholesky.h"

namespace hapsim {

enum class SolverKind { kBySize, kDirect, kIterative };

struct SolverChoice {
  SolverKind kind = SolverKind::kDirect;  // never kBySize
  // For a person: "conjugate gradients: 51600 unknowns, 3 right-hand sides; about 1.5 s direct
  // ...".
  std::string why;
};

// kBySize: the one that takes less time for this many right-hand sides of a body of tetrahedra, by
// measured costs (bench/results/sizes-growth.txt, calculix.txt); another wish is kept. `unknowns`;
// entries of the lower triangle; order of the elements.
SolverChoice choose_solver(SolverKind wished, int unknowns, std::size_t entries,
                           int right_hand_sides, int order = 1);

// A symmetric positive definite system of displacements (three unknowns a node).
class StiffnessSolver {
 public:
  // The analysis of the sparsity, once (direct), unless `order` is known from the same pattern.
  StiffnessSolver(const SymmetricSparse& pattern, SolverKind kind, std::vector<int> order = {});
  // False when the matrix is not positive definite.
  bool factorise(const SymmetricSparse& matrix);
  // The same of a matrix that an iterative solver gives back while it makes ready. `ends` of the
  // nodes (ConjugateGradients) may be empty.
  bool factorise(SymmetricSparse&& matrix, const BlockEnds& ends);
  // A X = B. Error(kNoConvergence) when the iteration stops above a relative residual of 2e-9.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  // In which blocks of three unknowns are eliminated; empty when iterative.
  std::vector<int> order() const { return direct_ ? direct_->order() : std::vector<int>{}; }
  // The most steps of any solution so far; 0 when direct.
  int iterations() const { return iterative_ ? iterative_->iterations() : 0; }
  std::size_t held_bytes() const {
    return hapsim::held_bytes(direct_) + hapsim::held_bytes(iterative_);
  }

 private:
  std::unique_ptr<SparseCholesky> direct_;
  std::unique_ptr<ConjugateGradients> iterative_;
};

}  // namespace hapsim
