#include "experiment/weights.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(Weights, WhitenTheirOwnCovariance) {
  Experiment w = test::experiment();
  const Selection selection{0, 1, 4};  // two positions
  const Eigen::VectorXd f = solved_forces(test::elastic(1e4, 0.4), w, selection, false).f;
  const double noise = 0.02, floor = 0.05;
  Eigen::MatrixXd V = noise * noise * Eigen::MatrixXd::Identity(f.size(), f.size());
  for (const GainBlock& block : gain_directions(w.dataset, selection, f)) {
    const Eigen::MatrixXd ZZ = block.Z * block.Z.transpose();
    for (std::size_t i = 0; i < block.rows.size(); ++i)
      for (std::size_t j = 0; j < block.rows.size(); ++j)
        V(block.rows[i], block.rows[j]) +=
            floor * floor * ZZ(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  const Weights weights(w.dataset, selection, f, noise, floor);
  Eigen::MatrixXd half = Eigen::MatrixXd::Identity(f.size(), f.size());
  weights.whiten(half);
  EXPECT_LT((half * V * half.transpose() - Eigen::MatrixXd::Identity(f.size(), f.size())).norm(),
            1e-9);
}

TEST(Weights, AStiffnessErrorOfOnePositionIsSpannedByItsDirections) {
  Experiment w = test::experiment();
  const Selection selection{0, 1, 2};  // one position, sideways as well
  const Eigen::VectorXd f = solved_forces(test::elastic(1e4, 0.4), w, selection, false).f;
  Eigen::Matrix3d error;
  error << 0.01, 0.004, -0.02, 0.004, -0.03, 0.005, -0.02, 0.005, 0.02;
  Eigen::VectorXd change(f.size());
  for (Eigen::Index i = 0; i < f.size(); i += 3) change.segment<3>(i) = error * f.segment<3>(i);
  const auto blocks = gain_directions(w.dataset, selection, f);
  ASSERT_EQ(blocks.size(), 1u);
  const Eigen::VectorXd x = blocks[0].Z.colPivHouseholderQr().solve(change);
  EXPECT_LT((blocks[0].Z * x - change).norm(), 1e-9 * change.norm());
}

}  // namespace
}  // namespace hapsim
