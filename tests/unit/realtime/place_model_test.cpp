#include "realtime/place_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

TEST(DiscCompliance, IsThePunchOnAHalfSpace) {
  const double E = 1e4, a = 0.01;
  // nu = 1/2: no bond matters, k = 2 E a / (1 - nu^2).
  const Eigen::Matrix3d soft = disc_compliance(E, 0.5, a, Vec3::UnitX());
  EXPECT_NEAR(1 / soft(0, 0), 2 * E * a / 0.75, 1e-6);
  EXPECT_NEAR(1 / disc_compliance(E, 0.4999, a, Vec3::UnitX())(0, 0), 2 * E * a / 0.75, 0.1);
  // nu = 0: k = 4 G a ln 3; across 8 G a / (2 - nu).
  const Eigen::Matrix3d cork = disc_compliance(E, 0, a, Vec3::UnitZ());
  EXPECT_NEAR(1 / cork(2, 2), 2 * E * a * std::log(3.0), 1e-9);
  EXPECT_NEAR(1 / cork(1, 1), 2 * E * a, 1e-9);
}

}  // namespace
}  // namespace hapsim
