#include "calibrate/pose_plan.h"

#include <gtest/gtest.h>

#include <sstream>

#include "unit/calibrate/rig.h"
#include "unit/robot/robots.h"

namespace hapsim {
namespace {

double largest(const PosePlan& plan, const std::string& begins, const Eigen::VectorXd& errors) {
  double most = 0;
  for (std::size_t k = 0; k < plan.names.size(); ++k)
    if (plan.names[k].rfind(begins, 0) == 0)
      most = std::max(most, errors[static_cast<Eigen::Index>(k)]);
  return most;
}

// Six poses in a plane lack the cross-talk; with the planned ones it is determined, as foretold.
TEST(PosePlan, WhatWasMissingIsDeterminedByIt) {
  const test::Rig rig;
  Random random(3);
  StaticPoses poses = test::recorded(rig, 6, random, false, false, false);
  for (std::size_t i = 0; i < 6; ++i) {
    const double a = static_cast<double>(i);
    poses.poses[i].orientation =
        Eigen::Quaterniond::FromTwoVectors(Vec3(std::cos(a), std::sin(a), 0), -Vec3::UnitZ())
            .toRotationMatrix();
    test::show(rig, random, poses.poses[i]);
  }
  const SensorFit before = fit_sensor(poses, {});
  EXPECT_FALSE(before.terms.crosstalk);
  const PosePlan plan = plan_poses(poses, before, {}, {.poses = 4});
  ASSERT_EQ(plan.poses.size(), 4u);
  EXPECT_GT(largest(plan, "crosstalk", plan.error_now), 0.05);
  for (const PlannedPose& planned : plan.poses) {
    StaticPose p{.line = 9, .orientation = planned.orientation, .temp = 20};
    EXPECT_LT((planned.down + planned.orientation.transpose() * Vec3::UnitZ()).norm(), 1e-9);
    test::show(rig, random, p);
    poses.poses.push_back(p);
  }
  const SensorFit after = fit_sensor(poses, {});
  ASSERT_TRUE(after.determined);
  EXPECT_TRUE(after.terms.crosstalk);
  double told = 0;
  for (std::size_t k = 0; k < after.unknowns.names.size(); ++k)
    if (after.unknowns.names[k].rfind("crosstalk", 0) == 0)
      told = std::max(told, std::sqrt(after.covariance(static_cast<Eigen::Index>(k),
                                                       static_cast<Eigen::Index>(k))));
  const double foretold = largest(plan, "crosstalk", plan.error_then);
  // The noise was taken for larger while the cross-talk was part of it.
  EXPECT_LT(told, 2 * foretold);
}

// As many planned poses know each number better than as many at random.
TEST(PosePlan, BeatsPosesAtRandom) {
  const PosePlan plan = plan_poses({}, {}, {}, {.poses = 12});
  ASSERT_EQ(plan.poses.size(), 12u);
  const SensorFit nothing;
  const SensorUnknowns unknowns = sensor_unknowns(wanted_terms({}, {}), nothing.state);
  const auto information = [&](const std::vector<StaticPose>& poses) {
    const Eigen::MatrixXd J = whitened_slopes(nothing.state, unknowns, poses, 0.01, 1);
    return std::log((J.transpose() * J).determinant());
  };
  std::vector<StaticPose> planned;
  for (const PlannedPose& p : plan.poses) planned.push_back({.orientation = p.orientation});
  double best = -1e9;
  for (int seed = 1; seed <= 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<StaticPose> poses(12);
    for (StaticPose& p : poses) p.orientation = test::any_orientation(random);
    best = std::max(best, information(poses));
  }
  EXPECT_GT(information(planned), best);
}

TEST(PosePlan, StaysWithinTheTiltAndTheRobot) {
  for (const PlannedPose& p : plan_poses({}, {}, {}, {.poses = 8, .tilt = 0.7}).poses)
    EXPECT_GT(-p.down.z(), std::cos(0.7) - 1e-9);
  const Robot robot(test::puma_urdf(), "puma.urdf", "", "");
  const PosePlan plan = plan_poses({}, {}, {}, {.poses = 5, .robot = &robot});
  for (const PlannedPose& p : plan.poses) {
    ASSERT_EQ(p.q.size(), 6);
    EXPECT_LT((robot.forward(p.q).linear() - p.orientation).norm(), 1e-12);
  }
  std::ostringstream out;
  write_pose_plan(out, plan, false);
  EXPECT_EQ(out.str().substr(0, 26), "pose,q1,q2,q3,q4,q5,q6,qw,");
}

}  // namespace
}  // namespace hapsim
