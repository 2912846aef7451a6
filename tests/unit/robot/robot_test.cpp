#include "robot/robot.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "expect_error.h"
#include "unit/robot/robots.h"

namespace hapsim {
namespace {

Eigen::VectorXd random_joints(const Robot& robot, Random& random) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const RobotJoint& j = robot.joints()[static_cast<std::size_t>(i)];
    const double lower = std::max(j.lower, -M_PI), upper = std::min(j.upper, M_PI);
    q[i] = lower + (upper - lower) * random.uniform();
  }
  return q;
}

TEST(Robot, ForwardIsThePumaOfTheTextbook) {
  const Robot robot(test::puma_urdf(), "puma.urdf", "", "");
  ASSERT_EQ(robot.joints().size(), 6u);
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const Eigen::VectorXd q = random_joints(robot, random);
    const Pose wanted = test::puma_closed_form(q);
    EXPECT_LT((robot.forward(q).matrix() - wanted.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Robot, ForwardIsTheProductOfMatricesForTheShippedArm) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "base", "sensor");
  Random random(2);
  for (int k = 0; k < 200; ++k) {
    const Eigen::VectorXd q = random_joints(robot, random);
    EXPECT_LT((robot.forward(q).matrix() - test::arm_product(q)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Robot, InverseThenForwardReturnsThePose) {
  const Robot arm(test::arm_urdf(), "arm.urdf", "", "");
  const Robot puma(test::puma_urdf(), "puma.urdf", "", "");
  Random random(3);
  for (const Robot* robot : {&arm, &puma}) {
    int found = 0;
    for (int k = 0; k < 200; ++k) {
      const Pose wanted = robot->forward(random_joints(*robot, random));
      const auto q = robot->inverse(wanted, robot->middle());
      if (!q) continue;
      ++found;
      EXPECT_LT((robot->forward(*q).matrix() - wanted.matrix()).cwiseAbs().maxCoeff(), 1e-9);
      for (Eigen::Index i = 0; i < q->size(); ++i) {
        EXPECT_GE((*q)[i], robot->joints()[static_cast<std::size_t>(i)].lower - 1e-8);
        EXPECT_LE((*q)[i], robot->joints()[static_cast<std::size_t>(i)].upper + 1e-8);
      }
    }
    // Every pose is reachable; poses near the limits ask for luck with the start.
    EXPECT_GE(found, 190);
  }
}

TEST(Robot, WhatIsOutOfReachIsNotFound) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "", "");
  Pose far = Pose::Identity();
  far.translation() = Vec3(2, 0, 0.3);
  EXPECT_FALSE(robot.inverse(far, robot.middle()));
  far.translation() = Vec3(0.05, 0, 0.33);  // within the shoulder
  EXPECT_FALSE(robot.inverse(far, robot.middle()));
}

std::string with_joint(const std::string& joint) {
  return "<robot name='r'><link name='a'/><link name='b'/>" + joint + "</robot>";
}

TEST(Robot, RefusesWhatItCannotUse) {
  const auto message = [](const std::string& urdf, const std::string& tip = "") {
    return error_of([&] { Robot(urdf, "r.urdf", "", tip); });
  };
  EXPECT_NE(message("").find("there is no <robot>"), std::string::npos);
  EXPECT_NE(message("<robot name='r'><link name='a'").find("cannot be read as URDF"),
            std::string::npos);
  EXPECT_NE(message("<xacro:macro/>").find("xacro FILE"), std::string::npos);
  EXPECT_NE(message(test::arm_urdf(), "senser").find("did you mean 'sensor'?"), std::string::npos);
  EXPECT_NE(message(test::arm_urdf(), "base").find("no joint moves"), std::string::npos);
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_NE(message(deep).find("nested"), std::string::npos);
  const std::string ends = "<parent link='a'/><child link='b'/>";
  EXPECT_NE(
      message(with_joint("<joint name='j' type='planar'>" + ends + "<axis xyz='1 0 0'/></joint>"))
          .find("neither turns nor slides"),
      std::string::npos);
  EXPECT_NE(message(with_joint("<joint name='j' type='continuous'>" + ends +
                               "<axis xyz='0 0 0'/></joint>"))
                .find("no axis"),
            std::string::npos);
  // Every prefix of a good file fails in one line or is good.
  const std::string good = test::arm_urdf();
  for (std::size_t n = 0; n < good.size(); n += 37) {
    try {
      Robot(good.substr(0, n), "r.urdf", "", "");
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace hapsim
