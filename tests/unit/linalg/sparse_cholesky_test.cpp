#include "linalg/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdlib>
#include <vector>

#include "base/blas.h"
#include "base/parallel.h"
#include "lower_triangle.h"

namespace hapsim {
namespace {

TEST(SparseCholesky, SolvesAsDense) {
  std::srand(3);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(30, 30);
  for (int b = 0; b + 6 <= 30; b += 3) {
    const Eigen::MatrixXd m = Eigen::MatrixXd::Random(6, 6);
    a.block<6, 6>(b, b) += m * m.transpose() + Eigen::MatrixXd::Identity(6, 6);
  }
  const SymmetricSparse matrix = test::lower_triangle(a);
  SparseCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.factorise(matrix));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(30, 4);
  EXPECT_LT((cholesky.solve(b) - a.ldlt().solve(b)).norm(), 1e-10);
}

TEST(SparseCholesky, RefusesIndefinite) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(6, 6);
  a(4, 4) = -1;
  const SymmetricSparse matrix = test::lower_triangle(a);
  SparseCholesky cholesky(matrix);
  EXPECT_FALSE(cholesky.factorise(matrix));
}

// Springs between the neighbours of a grid of n x n x n nodes, one unknown a node.
SymmetricSparse grid(int n) {
  SymmetricSparse matrix;
  matrix.size = n * n * n;
  matrix.column_start.push_back(0);
  for (int node = 0; node < matrix.size; ++node) {
    const auto add = [&](int row, double value) {
      matrix.row.push_back(row);
      matrix.value.push_back(value);
    };
    add(node, 6.1);
    if (node % n + 1 < n) add(node + 1, -1);
    if (node / n % n + 1 < n) add(node + n, -1);
    if (node / (n * n) + 1 < n) add(node + n * n, -1);
    matrix.column_start.push_back(static_cast<int>(matrix.row.size()));
  }
  return matrix;
}

TEST(SparseCholesky, GivesTheSameBytesBesideOtherThreads) {
  const SymmetricSparse matrix = grid(14);
  const auto solution = [&] {
    SparseCholesky cholesky(matrix, 1);
    EXPECT_TRUE(cholesky.factorise(matrix));
    return cholesky.solve(Eigen::VectorXd::LinSpaced(matrix.size, 0, 1));
  };
  const Eigen::MatrixXd alone = solution();
  std::vector<Eigen::MatrixXd> beside(8);
  in_parallel(beside.size(), 4, [&](std::size_t i) { beside[i] = solution(); });
  for (const Eigen::MatrixXd& x : beside) EXPECT_EQ(x, alone);
}

TEST(Blas, IsOpenBlas) {
  prepare_blas_for_many_threads();
  EXPECT_NE(blas_name().find("OpenBLAS"), std::string::npos)
      << blas_name() << ": install libopenblas0-pthread, else factorisation is slow";
}

// OpenBLAS by itself takes the oldest of all on a processor that is newer than it.
TEST(Blas, HasKernelsAsWideAsTheProcessor) {
#ifdef __x86_64__
  if (std::getenv("OPENBLAS_CORETYPE") != nullptr) return;
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
  EXPECT_EQ(blas_name().find("Prescott"), std::string::npos) << blas_name();
#endif
}

}  // namespace
}  // namespace hapsim
