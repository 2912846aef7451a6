#include "calibrate/static_poses.h"

#include <gtest/gtest.h>

#include "calibrate/given_gravity.h"
#include "support/expect_words.h"
#include "unit/robot/robots.h"

namespace hapsim {
namespace {

StaticPoses read(const std::string& text, const Robot* robot = nullptr, double factor = 1) {
  Input input = Input::from_bytes(text, "poses.csv");
  return read_static_poses(input, robot, factor);
}

TEST(StaticPoses, RowsOfOnePoseAreTheirMean) {
  const StaticPoses p = read(
      "pose,qw,qx,qy,qz,fx,fy,fz,tx,ty,tz,temp,load\n"
      "1,1,0,0,0,1,2,3,0,0,0,20,0\n1,1,0,0,0,3,2,1,0,0,2,22,0\n2,0,1,0,0,1,1,1,0,0,0,20,0.5\n");
  ASSERT_EQ(p.poses.size(), 2u);
  EXPECT_EQ(p.rows, 3u);
  EXPECT_EQ(p.repeated, 0u);
  EXPECT_EQ(p.poses[0].force, Vec3(2, 2, 2));
  EXPECT_EQ(p.poses[0].torque, Vec3(0, 0, 1));
  EXPECT_EQ(p.poses[0].temp, 21);
  EXPECT_EQ(p.poses[1].load, 0.5);
  EXPECT_EQ(p.poses[1].line, 4);
  EXPECT_TRUE(p.torques && p.temps && p.loads);
  const StaticPoses rows =
      read("qw,qx,qy,qz,fx,fy,fz\n1,0,0,0,1,2,3\n1,0,0,0,3,2,1\n0,1,0,0,1,1,1\n");
  EXPECT_EQ(rows.poses.size(), 3u);
  EXPECT_EQ(rows.repeated, 1u);
}

TEST(StaticPoses, JointAnglesOfARobot) {
  const Robot robot(test::puma_urdf(), "puma.urdf", "", "");
  const StaticPoses p =
      read("q1,q2,q3,q4,q5,q6,fx,fy,fz\n10,20,30,40,50,60,1,2,3\n", &robot, M_PI / 180);
  Eigen::VectorXd q(6);
  for (int j = 0; j < 6; ++j) q[j] = (j + 1) * M_PI / 18;
  EXPECT_LT((p.poses[0].orientation - robot.forward(q).linear()).norm(), 1e-12);
}

TEST(StaticPoses, WhatIsMissingIsSaid) {
  const auto refused = [](const std::string& text, const std::string& words) {
    expect_error([&] { read(text); }, ExitCode::kBadInput, words);
  };
  refused("qw,qx,qy,qz,fx,fy,fz\n", "add the recorded poses");
  refused("fx,fy,fz\n1,2,3\n", "no columns say how the tool was turned");
  refused("qw,qx,qy,qz,fx,fy\n1,0,0,0,1,2\n", "column 'fz' is missing");
  refused("qw,qx,qy,qz,fx,fy,fz,load\n1,0,0,0,1,2,3,-1\n", "poses.csv:2: load is -1 kg");
  refused("qw,qx,qy,qz,fx,fy,fz,tx\n1,0,0,0,1,2,3,0\n", "column 'ty' is missing");
}

TEST(GivenGravity, ThreeNumbersOrEstimate) {
  EXPECT_EQ(given_gravity("0,0,-9.81", "--gravity"), Vec3(0, 0, -9.81));
  EXPECT_EQ(given_gravity("estimate", "--gravity"), std::nullopt);
  for (const char* text : {"0,0", "0,0,-1", "0,0,x", "0,0,-9.8,1", ""})
    expect_error([&] { given_gravity(text, "--gravity"); }, ExitCode::kUsage, "--gravity: ");
}

}  // namespace
}  // namespace hapsim
