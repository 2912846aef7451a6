#include "linalg/schur_inverse.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "linalg/counts.h"
#include "lower_triangle.h"

namespace hapsim {
namespace {

// Blocks of three on a path with a few long links, positive definite.
Eigen::MatrixXd chain(int blocks, unsigned seed) {
  std::srand(seed);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * blocks, 3 * blocks);
  const auto link = [&](int b, int c) {
    const Eigen::MatrixXd m = Eigen::MatrixXd::Random(6, 6);
    const Eigen::MatrixXd s = m * m.transpose() + Eigen::MatrixXd::Identity(6, 6);
    a.block<3, 3>(3 * b, 3 * b) += s.topLeftCorner<3, 3>();
    a.block<3, 3>(3 * c, 3 * c) += s.bottomRightCorner<3, 3>();
    a.block<3, 3>(3 * b, 3 * c) += s.topRightCorner<3, 3>();
    a.block<3, 3>(3 * c, 3 * b) += s.bottomLeftCorner<3, 3>();
  };
  for (int b = 0; b + 1 < blocks; ++b) link(b, b + 1);
  for (int b = 0; b + 7 < blocks; b += 5) link(b, b + 7);
  return a;
}

Eigen::MatrixXd dense_answer(const Eigen::MatrixXd& a, const std::vector<char>& kept) {
  std::vector<int> rows;
  for (std::size_t b = 0; b < kept.size(); ++b)
    for (int i = 0; kept[b] && i < 3; ++i) rows.push_back(3 * static_cast<int>(b) + i);
  return Eigen::MatrixXd(a.inverse())(rows, rows);
}

TEST(SchurInverse, IsTheBlockOfTheInverse) {
  constexpr int kBlocks = 60;
  std::vector<std::vector<char>> cases(6, std::vector<char>(kBlocks, 0));
  cases[0].assign(kBlocks, 1);  // nothing to eliminate
  for (int b = 0; b < kBlocks; b += 2) cases[1][b] = 1;
  for (int b = 20; b < 40; ++b) cases[2][b] = 1;
  cases[3][0] = cases[3][59] = 1;  // far apart
  cases[4][17] = 1;
  for (int b = 0; b < kBlocks; ++b) cases[5][b] = b % 3 != 1;
  const Eigen::MatrixXd a = chain(kBlocks, 5);
  const SymmetricSparse matrix = test::lower_triangle(a);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    SchurInverse schur(matrix, cases[k]);
    Eigen::MatrixXd inverse;
    ASSERT_TRUE(schur.invert(matrix, inverse)) << "case " << k;
    const Eigen::MatrixXd expected = dense_answer(a, cases[k]);
    ASSERT_EQ(inverse.rows(), expected.rows());
    EXPECT_LT((inverse - expected).norm(), 1e-12 * expected.norm()) << "case " << k;
    EXPECT_EQ((inverse - inverse.transpose()).norm(), 0);
  }
}

TEST(SchurInverse, TakesNewValuesOnTheSamePattern) {
  std::vector<char> kept(40, 0);
  for (int b = 10; b < 30; ++b) kept[b] = 1;
  const Eigen::MatrixXd first = chain(40, 1), second = chain(40, 2);
  SchurInverse schur(test::lower_triangle(first), kept);
  const long analyses = solver_counts.analyses;
  Eigen::MatrixXd inverse;
  for (const Eigen::MatrixXd& a : {first, second, first}) {
    ASSERT_TRUE(schur.invert(test::lower_triangle(a), inverse));
    const Eigen::MatrixXd expected = dense_answer(a, kept);
    EXPECT_LT((inverse - expected).norm(), 1e-12 * expected.norm());
  }
  EXPECT_EQ(solver_counts.analyses, analyses);
}

TEST(SchurInverse, SolvesByTheSameFactor) {
  std::vector<char> kept(40, 0);
  for (int b = 12; b < 20; ++b) kept[b] = 1;
  const Eigen::MatrixXd a = chain(40, 3);
  SchurInverse schur(test::lower_triangle(a), kept);
  Eigen::MatrixXd inverse, b(a.rows(), 4);
  for (Eigen::Index i = 0; i < b.size(); ++i) b.data()[i] = std::sin(0.3 * static_cast<double>(i));
  ASSERT_TRUE(schur.invert(test::lower_triangle(a), inverse));
  const Eigen::MatrixXd x = schur.solve(b);
  EXPECT_LT((a.selfadjointView<Eigen::Lower>() * x - b).norm(), 1e-11 * b.norm());
}

TEST(SchurInverse, KeepsNothingAndRefusesIndefinite) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(6, 6), inverse;
  SchurInverse none(test::lower_triangle(a), {0, 0});
  EXPECT_TRUE(none.invert(test::lower_triangle(a), inverse));
  EXPECT_EQ(inverse.size(), 0);
  SchurInverse one(test::lower_triangle(a), {0, 1});
  a(4, 4) = -1;
  EXPECT_FALSE(one.invert(test::lower_triangle(a), inverse));
}

TEST(SchurInverse, ThreadsOfTheDensePartChangeNothing) {
  std::vector<char> kept(120, 1);
  for (int b = 0; b < 120; b += 3) kept[b] = 0;
  const SymmetricSparse matrix = test::lower_triangle(chain(120, 9));
  SchurInverse schur(matrix, kept);
  Eigen::MatrixXd one, two;
  ASSERT_TRUE(schur.invert(matrix, one, 1));
  ASSERT_TRUE(schur.invert(matrix, two, 2));
  EXPECT_LT((one - two).norm(), 1e-13 * one.norm());
}

}  // namespace
}  // namespace hapsim
