#include "safety/safe_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "safety/safety_words.h"
#include "support/allocations.h"

namespace hapsim {
namespace {

const Vec3 kHere = Vec3::Zero();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SafeForce, IsCutInSizeAndKeepsItsDirection) {
  SafeForce safe({});
  SafeSample s;
  for (int i = 0; i < 100; ++i) s = safe.pass(1e-3 * i, kHere, {0, 300, 400});
  EXPECT_NEAR(s.force.norm(), 10, 1e-9);
  EXPECT_NEAR(s.force.y() / s.force.z(), 0.75, 1e-12);
  EXPECT_EQ(s.flags, kSafeForce);
  EXPECT_EQ(s.unlimited, Vec3(0, 300, 400));
}

TEST(SafeForce, ChangesAtItsRate) {
  SafeForce safe({});
  EXPECT_NEAR(safe.pass(0, kHere, {0, 0, 5}).force.z(), 1, 1e-9) << "1000 N/s, a period";
  EXPECT_NEAR(safe.pass(1e-3, kHere, {0, 0, 5}).force.z(), 2, 1e-9);
  EXPECT_NEAR(safe.pass(1e-3, kHere, {0, 0, 5}).force.z(), 2, 1e-9) << "no time, no change";
  EXPECT_EQ(safe.pass(1e-3, kHere, {0, 0, 5}).flags, kSafeRate);
}

TEST(SafeForce, DoesNoMoreWorkThanAllowed) {
  SafetyLimits limits;
  limits.power = 0.5;
  limits.rate = 1e5;
  SafeForce safe(of_any_energy(limits));
  safe.pass(0, kHere, {0, 0, 2});
  const SafeSample pushed = safe.pass(1e-3, {0, 0, 1e-3}, {0, 0, 2});  // 1 m/s along the force
  EXPECT_NEAR(pushed.force.z(), 0.5, 1e-9);
  EXPECT_EQ(pushed.flags, kSafePower);
  EXPECT_EQ(safe.pass(2e-3, kHere, {0, 0, 2}).flags, 0) << "against it the hand does the work";
}

TEST(SafeForce, GivesNoMoreEnergyThanAllowed) {
  SafetyLimits limits;
  EXPECT_NEAR(limits.energy_bound(), 0.075, 1e-12)
      << "10 N to zero in 10 ms, a sample late, at 1 m/s; and a quarter";
  SafeForce safe(limits);
  double given = 0, last = 0, flagged = 0;
  for (int i = 0; i < 2000; ++i) {  // it pushes a hand that goes with it
    const SafeSample s = safe.pass(1e-3 * i, {0, 0, 1e-4 * i}, {0, 0, 5});
    if (i > 0) given += 1e-4 * last;
    last = s.force.z();
    flagged += (s.flags & kSafeEnergy) != 0;
    EXPECT_EQ(s.unlimited.z(), 5);
  }
  EXPECT_LT(given, 0.075 + 0.2 * 0.1);  // and what 1 N s/m took at 0.1 m/s
  EXPECT_LT(std::abs(last), 0.2);
  EXPECT_GT(flagged, 1900);
}

TEST(SafeForce, IsHeldThenRampedToZeroByTheClock) {
  SafeForce safe({});
  for (int i = 0; i < 50; ++i) safe.pass(1e-3 * i, kHere, {0, 0, 4});
  EXPECT_EQ(safe.miss(0.149).flags, kSafeHeld);
  EXPECT_EQ(safe.miss(0.149).force.z(), 4);
  EXPECT_FALSE(safe.lost());
  EXPECT_NEAR(safe.miss(0.249).force.z(), 2, 1e-9);
  EXPECT_TRUE(safe.lost());
  EXPECT_EQ(safe.miss(0.349).force, Vec3(0, 0, 0)) << "hold + ramp after the last sample";
  EXPECT_EQ(safe.miss(1e6).flags, kSafeRamped);
  // It comes back no faster than it went: 10 N in 0.2 s.
  EXPECT_NEAR(safe.pass(1e6 + 0.001, kHere, {0, 0, 4}).force.z(), 0.05, 1e-6);
  EXPECT_FALSE(safe.lost());
  EXPECT_EQ(safe.losses(), 1);
}

TEST(SafeForce, AStoppedProcessWakesAtZero) {
  SafeForce safe({});
  for (int i = 0; i < 50; ++i) safe.pass(1e-3 * i, kHere, {0, 0, 4});
  const SafeSample s = safe.pass(5, kHere, {0, 0, 4});  // nothing was asked for meanwhile
  EXPECT_LE(s.force.z(), 0.5 + 1e-9) << "0.01 s of 50 N/s";
  EXPECT_EQ(s.flags, kSafeRate);
}

TEST(SafeForce, WhatIsNoNumberIsNoSample) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {kNan, inf, -inf, 1e6}) {
    for (int k = 0; k < 6; ++k) {
      SafeForce safe({});
      for (int i = 0; i < 50; ++i) safe.pass(1e-3 * i, kHere, {0, 0, 4});
      Vec3 place = kHere, force(0, 0, 4);
      (k < 3 ? place : force)[k % 3] = bad;
      SafeSample s = safe.pass(0.05, place, force);
      EXPECT_EQ(s.flags, kSafeInvalid | kSafeHeld);
      EXPECT_EQ(s.force.z(), 4);
      EXPECT_TRUE(s.unlimited.allFinite());
      for (int i = 51; i < 400; ++i) s = safe.pass(1e-3 * i, place, force);
      EXPECT_EQ(s.force, Vec3(0, 0, 0)) << "and without valid ones it goes to zero";
    }
  }
  SafeForce safe({});
  EXPECT_EQ(safe.pass(kNan, kHere, {0, 0, 1}).force, Vec3(0, 0, 0));
  EXPECT_EQ(safe.miss(kNan).force, Vec3(0, 0, 0));
}

TEST(SafeForce, OutsideTheWorkspaceThereIsNone) {
  SafetyLimits limits;
  limits.low.z() = -0.01;
  SafeForce safe(limits);
  for (int i = 0; i < 50; ++i) safe.pass(1e-3 * i, kHere, {0, 0, 4});
  SafeSample s;
  for (int i = 50; i < 60; ++i) s = safe.pass(1e-3 * i, {0, 0, -0.02}, {0, 0, 4});
  EXPECT_EQ(s.force, Vec3(0, 0, 0));
  EXPECT_EQ(s.flags, kSafeOutside);
}

TEST(SafeForce, EndsWithZeroForGood) {
  SafeForce safe({});
  for (int i = 0; i < 50; ++i) safe.pass(1e-3 * i, kHere, {0, 0, 4});
  EXPECT_EQ(safe.zero().force, Vec3(0, 0, 0));
  EXPECT_EQ(safe.pass(0.051, kHere, {0, 0, 4}).force, Vec3(0, 0, 0));
  EXPECT_NE(safe.miss(0.052).flags & kSafeEnded, 0);
}

TEST(SafeForce, TakesNothingFromTheHeap) {
  SafeForce safe({});
  SafetyCounts counts;
  const long before = test::allocations;
  for (int i = 0; i < 1000; ++i) counts.add(safe.pass(1e-3 * i, kHere, {0, 0, 0.02 * i}));
  counts.add(safe.miss(9));
  counts.add(safe.zero());
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_EQ(counts.summary(), "force cut in 499, ramped in 1, ended in 1 of 1002 samples");
}

}  // namespace
}  // namespace hapsim
