// The grid without the nodes in the middles of edges, inside of one with them.
#include "linalg/midpoint_grid.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "linalg/block_sparse.h"
#include "lower_triangle.h"

namespace hapsim {
namespace {

// A chain of springs in three directions, of which every other node is a middle: nodes 0 (held),
// 1, 2, ..., 2 n (free), each spring coupling the ways a little.
constexpr int kCorners = 40;
int block_of(int node) {  // middles first, so that an order is needed
  return node == 0 ? -1 : node % 2 == 1 ? (node - 1) / 2 : kCorners + node / 2 - 1;
}

Eigen::MatrixXd chain() {
  const int size = 6 * kCorners;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  for (int n = 1; n <= 2 * kCorners; ++n) {
    Eigen::Matrix3d k = Eigen::Matrix3d::Identity() * (1 + 0.3 * std::sin(n));
    k(0, 1) = k(1, 0) = 0.2;
    const int r = block_of(n), c = block_of(n - 1);
    a.block<3, 3>(3 * r, 3 * r) += k;
    if (c < 0) continue;
    a.block<3, 3>(3 * c, 3 * c) += k;
    a.block<3, 3>(3 * r, 3 * c) -= k;
    a.block<3, 3>(3 * c, 3 * r) -= k;
    // An element of second order joins its three nodes.
    if (n % 2 == 1) continue;
    const int far = block_of(n - 2);
    if (far < 0) continue;
    a.block<3, 3>(3 * r, 3 * far).setConstant(1e-3);
    a.block<3, 3>(3 * far, 3 * r).setConstant(1e-3);
  }
  return a;
}

BlockEnds ends() {
  BlockEnds result(2 * kCorners);
  for (int n = 1; n <= 2 * kCorners; ++n) {
    const int b = block_of(n);
    result[b] = n % 2 == 0 ? std::array<int, 2>{b, b}
                           : std::array<int, 2>{block_of(n - 1), block_of(n + 1)};
  }
  return result;
}

// What it corrects is the part of an error that is linear between corners: of A P e it gives P e.
TEST(MidpointGrid, GivesBackWhatIsLinearBetweenCorners) {
  const Eigen::MatrixXd a = chain();
  const Eigen::Index size = a.rows();
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(size, 3 * kCorners);
  const BlockEnds of = ends();
  for (int b = 0; b < 2 * kCorners; ++b)
    for (const int e : of[b])
      if (e >= 0)
        for (int i = 0; i < 3; ++i) P(3 * b + i, 3 * (e - kCorners) + i) += 0.5;
  const Eigen::MatrixXd e = Eigen::MatrixXd::Random(P.cols(), kLanes);
  // In another order of the blocks, scaled as the fine grid is.
  std::vector<int> order(2 * kCorners);
  std::iota(order.begin(), order.end(), 0);
  std::reverse(order.begin(), order.end());
  Eigen::VectorXd scale(size);
  for (int b = 0; b < 2 * kCorners; ++b)
    for (int i = 0; i < 3; ++i) scale[3 * b + i] = 0.5 + 0.01 * b + 0.1 * i;
  const Eigen::MatrixXd u = P * e, f = a * u;
  std::vector<double> r(kLanes * size), z(kLanes * size);
  const auto unknown = [&](Eigen::Index row) {  // of the fine order
    return 3 * order[static_cast<std::size_t>(row / 3)] + row % 3;
  };
  MidpointGrid grid;
  grid.assemble(test::lower_triangle(a), of, order);
  ASSERT_TRUE(grid.factorise());
  for (Eigen::Index row = 0; row < size; ++row)
    for (int l = 0; l < kLanes; ++l) {
      r[kLanes * row + l] = scale[row] * f(unknown(row), l);
      z[kLanes * row + l] = 1;  // added to
    }
  grid.add_correction(scale, r, z);
  Eigen::MatrixXd off(size, kLanes), given(size, kLanes);
  for (Eigen::Index row = 0; row < size; ++row)
    for (int l = 0; l < kLanes; ++l) {
      given(unknown(row), l) = scale[row] * (z[kLanes * row + l] - 1);
      off(unknown(row), l) = given(unknown(row), l) - u(unknown(row), l);
    }
  // Linear between corners, and solved roughly: to a tenth of the load.
  const Eigen::MatrixXd corners = given.bottomRows(3 * kCorners);
  EXPECT_LT((given - P * corners).norm(), 1e-10 * given.norm());
  EXPECT_LT((P.transpose() * a * off).norm(), 0.11 * (P.transpose() * f).norm());
}

}  // namespace
}  // namespace hapsim
