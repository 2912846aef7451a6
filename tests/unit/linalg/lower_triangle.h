// A dense symmetric matrix as the solvers take it.
#pragma once

#include <Eigen/Core>

#include "linalg/sparse_cholesky.h"

namespace hapsim::test {

// Lower triangle of `dense`, zeros of whole 3x3 blocks off the diagonal left out.
inline SymmetricSparse lower_triangle(const Eigen::MatrixXd& dense) {
  SymmetricSparse matrix;
  matrix.size = static_cast<int>(dense.rows());
  matrix.column_start.push_back(0);
  for (int c = 0; c < matrix.size; ++c) {
    for (int r = c; r < matrix.size; ++r) {
      const auto block = dense.block<3, 3>(r / 3 * 3, c / 3 * 3);
      if (block.isZero() && r != c) continue;
      matrix.row.push_back(r);
      matrix.value.push_back(dense(r, c));
    }
    matrix.column_start.push_back(static_cast<int>(matrix.row.size()));
  }
  return matrix;
}

}  // namespace hapsim::test
