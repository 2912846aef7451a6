#include "linalg/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace hapsim {
namespace {

// Laplace's equation on n^3 points with a contrast of 100 between two halves: seven-point stencil.
SymmetricSparse laplacian(int n) {
  SymmetricSparse a;
  a.size = n * n * n;
  a.column_start.push_back(0);
  const auto conductivity = [n](int i) { return i < n / 2 ? 1.0 : 100.0; };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int c = (k * n + j) * n + i;
        const double here = conductivity(i);
        // A face between two cells has their harmonic mean; walls all around.
        const auto between = [&](int other) {
          if (other < 0 || other >= n) return here;
          const double there = conductivity(other);
          return 2 * here * there / (here + there);
        };
        a.row.push_back(c);
        a.value.push_back(4 * here + between(i - 1) + between(i + 1));
        if (i + 1 < n) a.row.push_back(c + 1), a.value.push_back(-between(i + 1));
        if (j + 1 < n) a.row.push_back(c + n), a.value.push_back(-here);
        if (k + 1 < n) a.row.push_back(c + n * n), a.value.push_back(-here);
        a.column_start.push_back(static_cast<int>(a.row.size()));
      }
  return a;
}

TEST(ConjugateGradients, SolvesAsCholeskyInFewSteps) {
  const SymmetricSparse a = laplacian(20);
  Eigen::VectorXd b(a.size);
  for (int i = 0; i < a.size; ++i) b[i] = std::sin(0.37 * i);
  SparseCholesky cholesky(a, 1);
  ASSERT_TRUE(cholesky.factorise(a));
  const Eigen::VectorXd exact = cholesky.solve(b);
  ConjugateGradients cg;
  ASSERT_TRUE(cg.prepare(a));
  EXPECT_EQ(cg.shift(), 0);  // an M-matrix needs none
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.size);
  const IterationReport report = cg.solve(a, b, x, 1e-10);
  EXPECT_TRUE(report.converged);
  EXPECT_LT((x - exact).norm(), 1e-8 * exact.norm());
  EXPECT_LT(report.iterations, 60);
  std::printf("%d steps for %d unknowns\n", report.iterations, a.size);
  // From the solution itself nothing is left to do.
  EXPECT_EQ(cg.solve(a, b, x, 1e-9).iterations, 0);
}

TEST(ConjugateGradients, SaysWhenItDoesNotConverge) {
  SymmetricSparse a = laplacian(10);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(a.size);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.size);
  ConjugateGradients cg;
  ASSERT_TRUE(cg.prepare(a));
  const IterationReport report = cg.solve(a, b, x, 1e-12, 3);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_GT(report.residual, 1e-12);
  a.value[0] = -1;
  EXPECT_FALSE(cg.prepare(a));
}

}  // namespace
}  // namespace hapsim
