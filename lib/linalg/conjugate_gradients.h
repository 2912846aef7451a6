// Conjugate gradients preconditioned by an incomplete Cholesky factor, for systems that are too
// large to factorise, or solved for too few right-hand sides to be worth it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "linalg/sparse_cholesky.h"

namespace hapsim {

// Of each block the two in whose middle it lies, as a node on an edge of second order; itself
// twice: in none; -1 for an end that is no unknown.
using BlockEnds = std::vector<std::array<int, 2>>;

struct IterationReport {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  // the largest |b - A x| / |b| of the columns
};

// Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49, 1952, up to four columns at a time over one
// pass through the matrix; IC(0) by blocks of the symmetrically scaled matrix (Meijerink and van
// der Vorst, Math. Comput. 31, 1977) in single precision, its diagonal raised until it exists
// (Manteuffel, Math. Comput. 34, 1980); unknowns in the order of Cuthill and McKee (ACM '69), which
// keeps what is near in memory. With the ends of edges known, the grid without nodes in their
// middles is solved beside the factor at each step (two levels, additively: Bramble, Pasciak and
// Xu, Math. Comput. 55, 1990), roughly, so that the directions are made conjugate as Polak and
// Ribiere do (flexible: Notay, SIAM J. Sci. Comput. 22, 2000): a fifth of the steps, and hardly
// more where the mesh is finer. Memory: the matrix one and a half times. One thread.
class ConjugateGradients {
 public:
  ConjugateGradients();
  ~ConjugateGradients();
  ConjugateGradients(ConjugateGradients&&) noexcept;
  ConjugateGradients& operator=(ConjugateGradients&&) noexcept;

  // Copies the matrix, gives it back, and factorises incompletely. `block` (1 or 3) consecutive
  // unknowns share their sparsity; `ends`, of blocks of three, may be empty. False when the
  // diagonal is not positive.
  bool prepare(SymmetricSparse matrix, int block = 3, const BlockEnds& ends = {});
  // Solves A X = B from the given X (size x m). A column stops at |b - A x| <= tolerance |b|; all
  // after `limit` steps (0: ten times the square root of the size, at least 1000). Not converged is
  // reported, not thrown.
  IterationReport solve(const Eigen::MatrixXd& b, Eigen::MatrixXd& x, double tolerance = 1e-8,
                        int limit = 0) const;
  std::size_t held_bytes() const;
  int iterations() const;  // the most of any solution since it was made
  double shift() const;    // by which the unit diagonal was raised

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
