// What the direction of a displacement has to do with a force's error, against drawn errors.
#include "realtime/direction_doubt.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

TEST(DirectionDoubt, IsThatOfDrawnErrorsOfTheLogarithm) {
  constexpr double kSize = 1e-3;
  constexpr int kDraws = 20000;
  const Eigen::Matrix3d turn = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized().matrix();
  const Eigen::Matrix3d root = turn * Vec3(1, 1.1, 3).asDiagonal() * turn.transpose();
  const Eigen::Matrix3d K = root * root;
  Random random(5);
  for (const Vec3& u : {Vec3(turn.col(0)), Vec3(turn.col(2)), Vec3(1, 0, 0), Vec3(1, 1, -1)}) {
    double squares = 0;
    for (int i = 0; i < kDraws; ++i) {
      Eigen::Matrix3d D;
      for (int r = 0; r < 3; ++r)
        for (int c = r; c < 3; ++c)
          D(r, c) = D(c, r) = kSize * random.normal() / (r == c ? 1 : std::sqrt(2.0));
      squares += (root * D * root * u).squaredNorm() / (K * u).squaredNorm();
    }
    const double over_isotropic = std::sqrt(squares / kDraws / (2 * kSize * kSize));
    EXPECT_NEAR(direction_doubt(K, u), over_isotropic, 0.02 * over_isotropic);
  }
}

TEST(DirectionDoubt, IsOneWhereAllDirectionsAreAlike) {
  const Eigen::Matrix3d K = 300 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(direction_doubt(K, {1, 2, 3}), 1, 1e-14);
  EXPECT_EQ(direction_doubt(K, Vec3::Zero()), 1);
  EXPECT_EQ(mean_direction_doubt(K), 1);
  const Eigen::Matrix3d limb = Vec3(1, 1, 9).asDiagonal();
  EXPECT_GT(direction_doubt(limb, {1, 0, 0}), 1.7);
  EXPECT_LT(direction_doubt(limb, {0, 0, 1}), 1);
  EXPECT_GT(mean_direction_doubt(limb), 1.1);
}

}  // namespace
}  // namespace hapsim
