// Sparse Cholesky factorisation of symmetric positive definite matrices (CHOLMOD, supernodal).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "base/held_bytes.h"

namespace hapsim {

// Lower triangle of a symmetric matrix in compressed columns, rows ascending within a column.
// The pattern is built once; the values are filled again and again.
struct SymmetricSparse {
  int size = 0;
  std::vector<int> column_start;  // size + 1
  std::vector<int> row;
  std::vector<double> value;
  std::size_t held_bytes() const {
    return hapsim::held_bytes(column_start) + hapsim::held_bytes(row) + hapsim::held_bytes(value);
  }
};

// Analyses a pattern once and factorises any values on it. Not to be shared between threads; one
// object a thread is safe.
class SparseCholesky {
 public:
  // `block` consecutive unknowns (3 for displacements) share their sparsity, so the fill-reducing
  // ordering (METIS nested dissection or AMD, the better) is found on the smaller graph of blocks,
  // unless it is `known`, from order() of the same pattern: a third of a small factorisation.
  explicit SparseCholesky(const SymmetricSparse& pattern, int block = 3,
                          std::vector<int> known = {});
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  // False when the matrix is not positive definite.
  bool factorise(const SymmetricSparse& matrix);
  // Solution of A X = B by the last factorisation; B is size x m.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides) const;
  const std::vector<int>& order() const;  // in which the blocks are eliminated
  double factor_nonzeros() const;
  std::size_t held_bytes() const;  // the factor and its work space

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
