#include "calibrate/sensor_model.h"

#include <gtest/gtest.h>

#include "unit/calibrate/rig.h"

namespace hapsim {
namespace {

TEST(SensorModel, ShowsWhatTheRigDoes) {
  test::Rig rig{.force_noise = 0, .torque_noise = 0};
  rig.gravity = Vec3(1, -2, -9);
  Random random(3);
  StaticPose pose{.orientation = test::any_orientation(random), .temp = 31, .load = 0.5};
  test::show(rig, random, pose);
  const Wrench shown = shown_wrench(test::state_of(rig), pose);
  EXPECT_LT((shown.value.head<3>() - pose.force).norm(), 1e-12);
  EXPECT_LT((shown.value.tail<3>() - pose.torque).norm(), 1e-12);
}

TEST(SensorModel, SlopesAgreeWithDifferences) {
  Random random(4);
  const StaticPose pose{.orientation = test::any_orientation(random), .temp = 31, .load = 0.5};
  SensorState state = test::state_of({});
  state.gravity = Vec3(1, -2, -9);
  for (const double sign : {1.0, -1.0}) {
    state.sign = sign;
    const Wrench at = shown_wrench(state, pose);
    for (int k = 0; k < kSensorNumbers; ++k) {
      const Eigen::VectorXd d = 1e-5 * Eigen::VectorXd::Unit(kSensorNumbers, k);
      const Eigen::VectorXd slope =
          (shown_wrench(moved(state, d), pose).value - shown_wrench(moved(state, -d), pose).value) /
          2e-5;
      EXPECT_LT((slope - at.slope.col(k)).norm(), 1e-7) << k;
    }
  }
}

}  // namespace
}  // namespace hapsim
