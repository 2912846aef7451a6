#include "calibrate/sensor_fit.h"

#include <gtest/gtest.h>

#include "calibrate/calibration_words.h"
#include "calibrate/pose_doubt.h"
#include "calibrate/sensor_result.h"
#include "calibrate/torque_test.h"
#include "unit/calibrate/rig.h"

namespace hapsim {
namespace {

// Degrees by which a rotation differs from the rig's.
double off_by(const Eigen::Matrix3d& R, const test::Rig& rig) {
  return Eigen::AngleAxisd(R * rig.R.transpose()).angle() * 180 / M_PI;
}

TEST(SensorFit, RecoversExactlyWithoutNoise) {
  const test::Rig rig{.force_noise = 0, .torque_noise = 0};
  Random random(1);
  const SensorFit fit = fit_sensor(test::recorded(rig, 12, random), {});
  ASSERT_TRUE(fit.determined);
  EXPECT_EQ(fit.terms.scale, Scale::kKnownWeight);
  EXPECT_LT(off_by(fit.state.rotation, rig), 1e-6);
  EXPECT_LT((fit.state.crosstalk - rig.C).norm(), 1e-8);
  EXPECT_NEAR(fit.state.mass, rig.mass, 1e-7);
  EXPECT_LT((fit.state.offset - rig.offset).norm(), 1e-7);
  EXPECT_LT((fit.state.drift - rig.drift).norm(), 1e-8);
  EXPECT_LT((fit.state.com - rig.com).norm(), 1e-8);
  EXPECT_LT((fit.state.torque_offset - rig.torque_offset).norm(), 1e-7);
  EXPECT_LT((fit.state.weight_at - rig.weight_at).norm(), 1e-8);
}

TEST(SensorFit, WithoutAKnownWeightTheMeanGainIsOne) {
  const test::Rig rig;
  const test::Rig same = test::of_mean_gain_one(rig);
  Random random(2);
  const StaticPoses poses = test::recorded(rig, 30, random, false);
  const SensorFit fit = fit_sensor(poses, {});
  ASSERT_TRUE(fit.determined);
  EXPECT_EQ(fit.terms.scale, Scale::kMeanGain);
  EXPECT_NEAR(fit.state.crosstalk.trace(), 3, 1e-12);
  EXPECT_LT((fit.state.crosstalk - same.C).norm(), 0.005);
  EXPECT_NEAR(fit.state.mass, same.mass, 0.01);
  const Calibration c = calibration_of(fit, poses, {});
  const Summary summary = calibration_summary(c, {.poses = &poses, .sensor = &fit});
  EXPECT_NE(summary.notes.front().find("No weight is known"), std::string::npos);
  // The weighed tool makes it known.
  const SensorFit weighed = fit_sensor(poses, {.mass = rig.mass});
  EXPECT_LT((weighed.state.crosstalk - rig.C).norm(), 0.005);
  EXPECT_EQ(calibration_of(weighed, poses, {.mass = rig.mass}).numbers[kMass].state, "given");
}

TEST(SensorFit, DirectionOfGravityIsFittedWhereAsked) {
  test::Rig rig;
  rig.gravity = 9.80665 * Vec3(0.9, 0.1, -0.3).normalized();  // a base on a wall
  Random random(5);
  const StaticPoses poses = test::recorded(rig, 30, random);
  const SensorFit fit = fit_sensor(poses, {.gravity = std::nullopt});
  ASSERT_TRUE(fit.determined);
  EXPECT_LT(fit.state.gravity.cross(rig.gravity).norm() / 96, 0.005);
  EXPECT_LT(off_by(fit.state.rotation, rig), 0.3);
}

TEST(SensorFit, ASensorThatShowsTheReactionIsSeen) {
  test::Rig rig;
  rig.C = -rig.C;
  Random random(6);
  const SensorFit fit = fit_sensor(test::recorded(rig, 30, random, true, false), {});
  ASSERT_TRUE(fit.determined);
  EXPECT_EQ(fit.state.sign, -1);
  EXPECT_LT(off_by(fit.state.rotation, rig), 0.3);
  EXPECT_LT((fit.state.crosstalk - rig.C).norm(), 0.005);
}

// Turns of the tool about the vertical alone: gravity never moves in its frame.
TEST(SensorFit, PosesThatTellNothingAreNotCalibrated) {
  const test::Rig rig;
  Random random(7);
  StaticPoses poses = test::recorded(rig, 12, random, false, false, false);
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    poses.poses[i].orientation =
        Eigen::AngleAxisd(0.5 * static_cast<double>(i), Vec3::UnitZ()).toRotationMatrix();
    test::show(rig, random, poses.poses[i]);
  }
  const SensorFit fit = fit_sensor(poses, {});
  EXPECT_FALSE(fit.determined);
  EXPECT_NE(undetermined_words(fit, poses, "").find("do not determine the sensor"),
            std::string::npos);
}

// A tool that leans to one side and the other of a plane: rotation, mass and offset, no cross-talk.
TEST(SensorFit, WhatIsNotDeterminedIsLeftOutAndSaid) {
  test::Rig rig;
  rig.C.setIdentity();
  Random random(8);
  StaticPoses poses = test::recorded(rig, 8, random, false, false, false);
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    const double a = 2 * M_PI * static_cast<double>(i) / 8;
    poses.poses[i].orientation =
        Eigen::Quaterniond::FromTwoVectors(Vec3(std::cos(a), std::sin(a), 0), -Vec3::UnitZ())
            .toRotationMatrix();
    test::show(rig, random, poses.poses[i]);
  }
  const SensorFit fit = fit_sensor(poses, {});
  ASSERT_TRUE(fit.determined);
  EXPECT_FALSE(fit.terms.crosstalk);
  ASSERT_EQ(fit.left_out.size(), 1u);
  EXPECT_EQ(fit.left_out[0], kOfCrosstalk);
  EXPECT_LT(off_by(fit.state.rotation, rig), 0.2);
  const Calibration c = calibration_of(fit, poses, {});
  EXPECT_FALSE(c.has(kCrosstalk));
  const Summary summary = calibration_summary(c, {.poses = &poses, .sensor = &fit});
  EXPECT_EQ(summary.mark, Summary::Mark::kOpen);
  // Where it must be fitted there is no calibration.
  EXPECT_FALSE(fit_sensor(poses, {.crosstalk = "on"}).determined);
}

TEST(SensorFit, TheOutlierIsNamed) {
  const test::Rig rig;
  Random random(9);
  StaticPoses poses = test::recorded(rig, 30, random);
  poses.poses[11].force.y() += 1;
  const SensorFit fit = fit_sensor(poses, {});
  const Summary summary =
      calibration_summary(calibration_of(fit, poses, {}), {.poses = &poses, .sensor = &fit});
  bool named = false;
  for (const std::string& note : summary.notes)
    named = named || note.find("The pose of line 13 is") != std::string::npos;
  EXPECT_TRUE(named);
}

TEST(PoseDoubt, InverseOrientationsAndForgottenWeightsAreTold) {
  const test::Rig rig;
  Random random(10);
  StaticPoses poses = test::recorded(rig, 20, random, true, false);
  EXPECT_EQ(pose_doubt(fit_sensor(poses, {}), poses, {}), "");
  StaticPoses inverse = poses;
  for (StaticPose& p : inverse.poses) p.orientation.transposeInPlace();
  EXPECT_NE(pose_doubt(fit_sensor(inverse, {}), inverse, {}).find("give those of the tool in the"),
            std::string::npos);
  for (StaticPose& p : poses.poses) p.load = 0;
  EXPECT_NE(pose_doubt(fit_sensor(poses, {}), poses, {}).find("is a weight missing"),
            std::string::npos);
}

TEST(TorqueTest, ForceInTheTorquesIsSeenAndNoiseIsNot) {
  const test::Rig rig;
  int alarms = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    StaticPoses poses = test::recorded(rig, 20, random);
    alarms += torque_follows_force(fit_sensor(poses, {}), poses) < 0.05;
    if (seed > 5) continue;
    for (StaticPose& p : poses.poses) p.torque.x() += 0.002 * (p.force.x() - 3);
    EXPECT_LT(torque_follows_force(fit_sensor(poses, {}), poses), 1e-3);
  }
  EXPECT_LE(alarms, 12);
}

}  // namespace
}  // namespace hapsim
