#include "rig/orientation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "io/csv.h"
#include "rig/rotation_vector.h"
#include "support/expect_words.h"

namespace hapsim {
namespace {

std::vector<Eigen::Matrix3d> orientations(const std::string& text) {
  Input input = Input::from_bytes(text, "poses.csv");
  const CsvTable table = read_csv(input);
  return read_orientations({table.name, table.header, table.columns, table.line});
}

TEST(Orientation, AllConventionsSayTheSame) {
  // A quarter turn about z: the tool's x points along the base's y.
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for (const char* text :
       {"qw,qx,qy,qz\n0.70710678,0,0,0.70710678\n",
        "r11,r12,r13,r21,r22,r23,r31,r32,r33\n0,-1,0,1,0,0,0,0,1\n",
        "rotvec_x,rotvec_y,rotvec_z\n0,0,1.57079633\n", "roll,pitch,yaw\n0,0,1.57079633\n"}) {
    const auto all = orientations(text);
    ASSERT_EQ(all.size(), 1u) << text;
    EXPECT_LT((all[0] - R).norm(), 1e-7) << text;
  }
  EXPECT_LT((orientation_of("0.70710678,0,0,0.70710678", "a.csv") - R).norm(), 1e-7);
  EXPECT_TRUE(orientations("x,fx\n1,2\n").empty());
}

TEST(Orientation, AnglesFollowEachOtherAsInUrdf) {
  const auto all = orientations("roll,pitch,yaw\n0.3,-0.4,1.1\n");
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  EXPECT_LT((all[0] - R).norm(), 1e-12);
}

TEST(Orientation, WhatIsNoneIsRefusedWithItsLine) {
  expect_error([] { orientations("qw,qx,qy,qz\n1,0,0,0\n1,1,0,0\n"); }, ExitCode::kBadInput,
               "poses.csv:3: the quaternion has length 1.414, not 1");
  expect_error([] { orientations("roll,pitch,yaw\n0,0,90\n"); }, ExitCode::kBadInput,
               "are these degrees?");
  expect_error([] { orientations("qw,qx,qy\n1,0,0\n"); }, ExitCode::kBadInput,
               "column 'qz' is missing");
  expect_error([] { orientations("r11,r12,r13,r21,r22,r23,r31,r32,r33\n1,0,0,0,1,0,0,0,-1\n"); },
               ExitCode::kBadInput, "r11 to r33 are no rotation");
  expect_error([] { orientation_of("1,0,0", "data.csv"); }, ExitCode::kBadInput,
               "the metadata orientation is");
}

TEST(RotationVector, ThereAndBackAndItsJacobian) {
  for (const Vec3& w : {Vec3(0, 0, 0), Vec3(1e-9, 0, 2e-9), Vec3(0.3, -0.2, 0.9), Vec3(0, 3.1, 0),
                        Vec3(1e-6, 2e-5, 0)}) {
    EXPECT_LT((rotation_vector(rotation_of(w)) - w).norm(), 1e-12 + 1e-9 * w.norm());
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = 1e-6 * Vec3::Unit(k);
      const Vec3 turned =
          rotation_vector(rotation_of(w + d) * rotation_of(w - d).transpose()) / 2e-6;
      EXPECT_LT((turned - left_jacobian(w).col(k)).norm(), 1e-8);
    }
  }
}

}  // namespace
}  // namespace hapsim
