#include "linalg/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/random.h"
#include "laplacian.h"
#include "linalg/cuthill_mckee.h"

namespace hapsim {
namespace {

TEST(ConjugateGradients, SolvesAsCholeskyInFewSteps) {
  const SymmetricSparse a = laplacian(20);
  Eigen::VectorXd b(a.size);
  for (int i = 0; i < a.size; ++i) b[i] = std::sin(0.37 * i);
  SparseCholesky cholesky(a, 1);
  ASSERT_TRUE(cholesky.factorise(a));
  const Eigen::VectorXd exact = cholesky.solve(b);
  ConjugateGradients cg;
  ASSERT_TRUE(cg.prepare(a, 1));
  EXPECT_EQ(cg.shift(), 0);  // an M-matrix needs none
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(a.size, 1);
  const IterationReport report = cg.solve(b, x, 1e-10);
  EXPECT_TRUE(report.converged);
  EXPECT_LT((x - exact).norm(), 1e-8 * exact.norm());
  EXPECT_LT(report.iterations, 60);
  std::printf("%d steps for %d unknowns\n", report.iterations, a.size);
  // From the solution itself nothing is left to do.
  EXPECT_EQ(cg.solve(b, x, 1e-9).iterations, 0);
}

TEST(ConjugateGradients, SaysWhenItDoesNotConverge) {
  SymmetricSparse a = laplacian(10);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(a.size);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(a.size, 1);
  ConjugateGradients cg;
  ASSERT_TRUE(cg.prepare(a, 1));
  const IterationReport report = cg.solve(b, x, 1e-12, 3);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_GT(report.residual, 1e-12);
  a.value[0] = -1;
  EXPECT_FALSE(cg.prepare(a, 1));
}

// Blocks of three: random symmetric couplings along a ladder, strong diagonals.
SymmetricSparse ladder(int blocks) {
  SymmetricSparse a;
  a.size = 3 * blocks;
  a.column_start.push_back(0);
  Random random(5);
  for (int b = 0; b < blocks; ++b)
    for (int k = 0; k < 3; ++k) {
      for (const int other : {b, b + 1, b + 7}) {
        if (other >= blocks) continue;
        for (int l = other == b ? k : 0; l < 3; ++l) {
          const bool diagonal = other == b && l == k;
          a.row.push_back(3 * other + l);
          a.value.push_back(diagonal ? 10 + 20 * random.uniform() : 2 * random.uniform() - 1);
        }
      }
      a.column_start.push_back(static_cast<int>(a.row.size()));
    }
  return a;
}

TEST(ConjugateGradients, SolvesColumnsTogetherByBlocks) {
  const SymmetricSparse a = ladder(200);
  SparseCholesky cholesky(a, 3);
  ASSERT_TRUE(cholesky.factorise(a));
  Eigen::MatrixXd b(a.size, 6);
  for (Eigen::Index j = 0; j < b.cols(); ++j)
    for (Eigen::Index i = 0; i < b.rows(); ++i)
      b(i, j) = std::sin(0.1 * static_cast<double>((j + 1) * i));
  b.col(4).setZero();
  ConjugateGradients cg;
  ASSERT_TRUE(cg.prepare(a, 3));
  Eigen::MatrixXd x = Eigen::MatrixXd::Constant(b.rows(), b.cols(), 0.1);
  const IterationReport report = cg.solve(b, x, 1e-12);
  EXPECT_TRUE(report.converged);
  EXPECT_LT((x - cholesky.solve(b)).norm(), 1e-10 * x.norm());
  EXPECT_EQ(x.col(4).norm(), 0);
  // A factor on the pattern of the matrix is nearly the whole one here.
  EXPECT_LT(report.iterations, 20);
}

TEST(CuthillMckee, MakesTheBandOfALadderNarrow) {
  LowerPattern ladder;
  const int n = 60;  // two rails of 30, numbered one after the other
  ladder.start.push_back(0);
  for (int i = 0; i < n; ++i) {
    ladder.row.push_back(i);
    if (i % 30 != 29) ladder.row.push_back(i + 1);
    if (i < 30) ladder.row.push_back(i + 30);
    ladder.start.push_back(static_cast<int>(ladder.row.size()));
  }
  const std::vector<int> order = cuthill_mckee_order(ladder);
  std::vector<int> place(order.size(), -1);
  for (int k = 0; k < n; ++k) place[order[k]] = k;
  int width = 0;
  for (int c = 0; c < n; ++c)
    for (int k = ladder.start[c]; k < ladder.start[c + 1]; ++k)
      width = std::max(width, std::abs(place[c] - place[ladder.row[k]]));
  EXPECT_LE(width, 3);
}

}  // namespace
}  // namespace hapsim
