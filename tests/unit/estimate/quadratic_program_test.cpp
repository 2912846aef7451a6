#include "estimate/quadratic_program.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// Against what every end must have (Karush, Kuhn and Tucker): these conditions have one solution.
TEST(QuadraticProgram, KeepsTheConditionsOfItsEnd) {
  Random random(3);
  int binding = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto n = static_cast<Eigen::Index>(2 + random.integer(6));
    const auto rows = static_cast<Eigen::Index>(1 + random.integer(12));
    const auto any = [&] { return 2 * random.uniform() - 1; };
    QuadraticProgram p;
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, any);
    p.H = root.transpose() * root + 1e-3 * Eigen::MatrixXd::Identity(n, n);
    p.f = Eigen::VectorXd::NullaryExpr(n, any);
    p.A = Eigen::MatrixXd::NullaryExpr(rows, n, any);
    // Kept at one point, which lies on a third of the rows.
    const Eigen::VectorXd point = Eigen::VectorXd::NullaryExpr(n, any);
    p.b = p.A * point;
    for (Eigen::Index c = 0; c < rows; ++c) {
      p.equality.push_back(c == 0 && trial % 2 == 0);
      if (c % 3 != 0) p.b[c] -= random.uniform();
    }
    const auto end = solve(p);
    ASSERT_TRUE(end.has_value()) << trial;
    const double size = 1 + end->d.norm() + end->multiplier.norm();
    const Eigen::VectorXd slack = p.A * end->d - p.b;
    EXPECT_LT((p.H * end->d + p.f - p.A.transpose() * end->multiplier).norm(), 1e-9 * size);
    for (Eigen::Index c = 0; c < rows; ++c) {
      binding += end->multiplier[c] > 0;
      if (p.equality[static_cast<std::size_t>(c)]) {
        EXPECT_NEAR(slack[c], 0, 1e-9 * size);
        continue;
      }
      EXPECT_GT(slack[c], -1e-9 * size);
      EXPECT_GE(end->multiplier[c], 0);
      EXPECT_NEAR(end->multiplier[c] * slack[c], 0, 1e-8 * size * size);
    }
  }
  EXPECT_GT(binding, 300);
}

TEST(QuadraticProgram, SaysWhereNothingKeepsThem) {
  QuadraticProgram p;
  p.H = Eigen::MatrixXd::Identity(2, 2);
  p.f = Eigen::VectorXd::Zero(2);
  p.A = Eigen::MatrixXd(2, 2);
  p.A << 1, 1, -1, -1;
  p.b = Eigen::Vector2d(1, -0.5);
  p.equality = {false, false};
  EXPECT_FALSE(solve(p).has_value());
}

}  // namespace
}  // namespace hapsim
