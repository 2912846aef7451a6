// Entries of an inverse against the dense one.
#include "linalg/selected_inverse.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "laplacian.h"

namespace hapsim {
namespace {

TEST(SelectedInverse, IsTheDenseOneOnThePattern) {
  const SymmetricSparse matrix = laplacian(7);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.size, matrix.size);
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[c]; k < matrix.column_start[c + 1]; ++k)
      dense(matrix.row[k], c) = dense(c, matrix.row[k]) = matrix.value[k];
  const Eigen::MatrixXd inverse = dense.inverse();
  const Eigen::VectorXd entries = inverse_on_pattern(matrix, SparseCholesky(matrix, 1).order());
  ASSERT_EQ(entries.size(), static_cast<Eigen::Index>(matrix.row.size()));
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[c]; k < matrix.column_start[c + 1]; ++k)
      EXPECT_NEAR(entries[k], inverse(matrix.row[k], c), 1e-10 * inverse(c, c));
}

TEST(SelectedInverse, OfAnIndefiniteMatrixIsNone) {
  SymmetricSparse matrix = laplacian(3);
  matrix.value[0] = -1;
  EXPECT_EQ(inverse_on_pattern(matrix, SparseCholesky(matrix, 1).order()).size(), 0);
}

}  // namespace
}  // namespace hapsim
