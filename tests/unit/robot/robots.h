// Robots for the tests, with closed forms that owe nothing to the code under test.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "robot/robot.h"

namespace hapsim::test {

inline std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

constexpr double kA2 = 0.4318, kA3 = 0.0203, kD3 = 0.1254, kD4 = 0.4318;

// The Unimation PUMA 560 by its modified Denavit-Hartenberg parameters.
inline std::string puma_urdf() {
  struct Row {
    double alpha, a, d;
  };
  const double quarter = M_PI / 2;
  const Row rows[] = {{0, 0, 0},       {-quarter, 0, 0}, {0, kA2, kD3}, {-quarter, kA3, kD4},
                      {quarter, 0, 0}, {-quarter, 0, 0}};
  std::string text = "<robot name='puma'><link name='l0'/>";
  for (int i = 0; i < 6; ++i) {
    const Row& r = rows[i];
    // Rx(alpha) Tx(a) Tz(d): the joint turns about the z of what follows.
    text += fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='continuous'><parent link='l{1}'/>"
        "<child link='l{0}'/><origin xyz='{2:.17g} {3:.17g} {4:.17g}' rpy='{5:.17g} 0 0'/>"
        "<axis xyz='0 0 1'/></joint>",
        i + 1, i, r.a, -std::sin(r.alpha) * r.d, std::cos(r.alpha) * r.d, r.alpha);
  }
  return text + "</robot>";
}

// J. J. Craig, Introduction to Robotics, 3rd ed., eq. (3.14): the PUMA's wrist frame in closed
// form.
inline Pose puma_closed_form(const Eigen::VectorXd& q) {
  const double c1 = cos(q[0]), s1 = sin(q[0]), c2 = cos(q[1]), s2 = sin(q[1]);
  const double c23 = cos(q[1] + q[2]), s23 = sin(q[1] + q[2]), c4 = cos(q[3]), s4 = sin(q[3]);
  const double c5 = cos(q[4]), s5 = sin(q[4]), c6 = cos(q[5]), s6 = sin(q[5]);
  Pose pose = Pose::Identity();
  auto r = pose.linear();
  r(0, 0) = c1 * (c23 * (c4 * c5 * c6 - s4 * s6) - s23 * s5 * c6) + s1 * (s4 * c5 * c6 + c4 * s6);
  r(1, 0) = s1 * (c23 * (c4 * c5 * c6 - s4 * s6) - s23 * s5 * c6) - c1 * (s4 * c5 * c6 + c4 * s6);
  r(2, 0) = -s23 * (c4 * c5 * c6 - s4 * s6) - c23 * s5 * c6;
  r(0, 1) = c1 * (c23 * (-c4 * c5 * s6 - s4 * c6) + s23 * s5 * s6) + s1 * (c4 * c6 - s4 * c5 * s6);
  r(1, 1) = s1 * (c23 * (-c4 * c5 * s6 - s4 * c6) + s23 * s5 * s6) - c1 * (c4 * c6 - s4 * c5 * s6);
  r(2, 1) = -s23 * (-c4 * c5 * s6 - s4 * c6) + c23 * s5 * s6;
  r(0, 2) = -c1 * (c23 * c4 * s5 + s23 * c5) - s1 * s4 * s5;
  r(1, 2) = -s1 * (c23 * c4 * s5 + s23 * c5) + c1 * s4 * s5;
  r(2, 2) = s23 * c4 * s5 - c23 * c5;
  const double out = kA2 * c2 + kA3 * c23 - kD4 * s23;
  pose.translation() =
      Vec3(c1 * out - kD3 * s1, s1 * out + kD3 * c1, -kA3 * s23 - kA2 * s2 - kD4 * c23);
  return pose;
}

// The shipped arm as a product of 4x4 matrices written out.
inline Eigen::Matrix4d arm_product(const Eigen::VectorXd& q) {
  const auto rot = [](int axis, double angle) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    m(i, i) = m(j, j) = cos(angle);
    m(j, i) = sin(angle);
    m(i, j) = -sin(angle);
    return m;
  };
  const auto move = [](double x, double y, double z) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topRightCorner<3, 1>() << x, y, z;
    return m;
  };
  return move(0, 0, 0.33) * rot(2, q[0]) * move(0.05, 0, 0) * rot(1, q[1]) * move(0, 0, 0.44) *
         rot(1, q[2]) * move(0.20, 0, 0.035) * rot(0, q[3]) * move(0.22, 0, 0) * rot(1, q[4]) *
         move(0.08, 0, 0) * rot(0, q[5]) * move(0.01, 0, 0) * rot(1, M_PI / 2);
}

inline std::string arm_urdf() {
  return file_text(std::string(HAPSIM_SOURCE_DIR) + "/share/examples/robot/arm.urdf");
}

}  // namespace hapsim::test
