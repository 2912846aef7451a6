// Tools that press and turn, and a device whose loop hangs.
#include "safety/safe_tools.h"

#include <gtest/gtest.h>

#include <cmath>

#include "safety/safe_device.h"

namespace hapsim {
namespace {

ToolFeel feel_of(const Vec3& force, const Vec3& torque) {
  ToolFeel feel;
  feel.press = 1;
  feel.in_air = false;
  feel.force = force;
  feel.torque = torque;
  return feel;
}

TEST(SafeTools, WithinTheLimitsForceAndTorqueAreToTheBit) {
  SafeTools safe({}, 2);
  for (int i = 0; i < 1000; ++i) {
    const double s = std::sin(0.01 * i), t = 1e-3 * i;
    const Vec3 force(0.3 * s, 0.1 * s, 2.0 / 3 * s), torque(0.01 / 3 * s, 0.02 * s, -0.007 * s);
    for (std::size_t k = 0; k < 2; ++k) {
      ToolFeel feel = feel_of(force, torque);
      safe.limit(k, t, Vec3::Zero(), Vec3::Zero(), feel, t);
      ASSERT_EQ(feel.safety, 0) << i;
      ASSERT_EQ(feel.force, force);
      ASSERT_EQ(feel.torque, torque);
      ASSERT_EQ(feel.asked_force, force);
      ASSERT_EQ(feel.asked_torque, torque);
    }
  }
}

TEST(SafeTools, ATorqueIsLimitedAsItsForceAtTheLever) {
  const SafetyLimits limits;
  SafeTools safe(limits, 1);
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 100; ++i) {
    ToolFeel feel = feel_of(Vec3::Zero(), {0, 5, 0});
    safe.limit(0, 1e-3 * i, Vec3::Zero(), Vec3::Zero(), feel, 1e-3 * i);
    EXPECT_LE((feel.torque - before).norm(), limits.lever * 1.0 * (1 + 1e-9));
    EXPECT_NE(feel.safety, 0);
    EXPECT_EQ(feel.asked_torque, Vec3(0, 5, 0));
    before = feel.torque;
  }
  EXPECT_NEAR(before.y(), 0.3, 1e-12);
  // What is no number is none, of either.
  ToolFeel bad = feel_of({0, 0, 1}, {0, std::nan(""), 0});
  safe.limit(0, 0.1, Vec3::Zero(), Vec3::Zero(), bad, 0.1);
  EXPECT_TRUE(bad.torque.allFinite() && bad.asked_torque.allFinite());
  EXPECT_NE(bad.safety & kSafeInvalid, 0);
}

TEST(SafeTools, OutsideTheWorkspaceThereIsNoTorqueEither) {
  SafetyLimits limits;
  limits.low = {-1, -1, -1};
  limits.high = {1, 1, 1};
  SafeTools safe(limits, 1);
  ToolFeel feel;
  for (int i = 0; i < 500; ++i) {
    feel = feel_of({0, 0, 3}, {0, 0.1, 0});
    safe.limit(0, 1e-3 * i, {i < 200 ? 0.0 : 2.0, 0, 0}, Vec3::Zero(), feel, 1e-3 * i);
  }
  EXPECT_EQ(feel.force, Vec3(0, 0, 0));
  EXPECT_EQ(feel.torque, Vec3(0, 0, 0));
  EXPECT_NE(feel.safety & kSafeOutside, 0);
}

// The loop answers none any more: the same answer gets older and older.
TEST(LateTools, ALoopThatHangsIsHeldThenRampedToZero) {
  LateTools device({}, 1);
  const std::array<ToolPose, 1> poses{};
  std::array<ToolFeel, 1> feel;
  const auto felt = [&](int ms, std::uint64_t age) {
    feel[0] = feel_of({0, 0, 2}, {0, 0.05, 0});
    device.limit(10 + 1e-3 * ms, poses, feel, age);
    return feel[0];
  };
  EXPECT_EQ(felt(0, DeviceLink::kNever).force, Vec3(0, 0, 0)) << "none yet";
  for (int ms = 1; ms < 200; ++ms) felt(ms, 0);
  EXPECT_EQ(feel[0].force.z(), 2);
  for (int ms = 200; ms < 290; ++ms) EXPECT_EQ(felt(ms, ms - 199).force.z(), 2) << ms;
  for (int ms = 290; ms < 310; ++ms) felt(ms, ms - 199);
  EXPECT_TRUE(device.lost());
  for (int ms = 310; ms < 500; ++ms) felt(ms, ms - 199);
  EXPECT_EQ(felt(500, 301).force, Vec3(0, 0, 0));
  EXPECT_EQ(feel[0].torque, Vec3(0, 0, 0));
  EXPECT_NE(feel[0].safety & kSafeRamped, 0);
  // It answers again: back on a slope.
  EXPECT_LE(felt(501, 0).force.z(), 0.1);
  EXPECT_FALSE(device.lost());
  device.zero(feel);
  EXPECT_EQ(felt(502, 0).force, Vec3(0, 0, 0)) << "for good";
}

}  // namespace
}  // namespace hapsim
