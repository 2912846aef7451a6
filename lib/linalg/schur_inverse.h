// Dense block of the inverse of a sparse positive definite matrix over a few of its unknowns.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "linalg/sparse_cholesky.h"

namespace hapsim {

// With the kept unknowns ordered last, the trailing block L_kk of A = L L' is the Cholesky factor
// of the Schur complement S = A_kk - A_ke A_ee^-1 A_ek, and (A^-1)_kk = S^-1 = L_kk^-T L_kk^-1
// (Golub and Van Loan, Matrix Computations, 3.2 and 4.2): one sparse factorisation and one dense
// inverse in place of a solution a column. The pattern is analysed once and takes any values after.
// Not to be shared between threads; one object a thread is safe.
class SchurInverse {
 public:
  // `kept`: one a block of `block` consecutive unknowns, 1: wanted. The others are ordered by
  // nested dissection or minimum degree, whichever fills less.
  SchurInverse(const SymmetricSparse& pattern, const std::vector<char>& kept, int block = 3);
  ~SchurInverse();
  SchurInverse(const SchurInverse&) = delete;
  SchurInverse& operator=(const SchurInverse&) = delete;

  // (A^-1)_kk, symmetric, kept unknowns in ascending order, into `inverse` (resized where it must
  // be). False when the matrix is not positive definite. `threads` of the dense part. Cost: the
  // factorisation and 2/3 kept^3 flops; memory: the factor and kept^2 numbers.
  bool invert(const SymmetricSparse& matrix, Eigen::MatrixXd& inverse, int threads = 1);

  // Solution of A X = B (size x m) by the factor of the last invert().
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  Eigen::Index kept() const;
  double factor_nonzeros() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
