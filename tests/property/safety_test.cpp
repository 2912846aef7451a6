// Whatever goes into SafeForce, what comes out of it is safe: random streams with every fault.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/random.h"
#include "safety/safe_force.h"

namespace hapsim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

SafetyLimits limits_of_a_box(Random& random) {
  SafetyLimits limits;
  limits.force = std::pow(10, 2 * random.uniform() - 0.5);
  limits.ramp = 0.02 + 0.3 * random.uniform();
  limits.rate = limits.force / limits.ramp * (1 + 100 * random.uniform());
  limits.power = std::pow(10, 3 * random.uniform() - 1);
  limits.hold = 0.005 + 0.2 * random.uniform();
  for (int k = 0; k < 3; ++k) {
    limits.low[k] = -0.05 - random.uniform();
    limits.high[k] = 0.05 + random.uniform();
  }
  return limits;
}

double any_double(Random& random) {
  const double kinds[] = {std::nan(""), kInf, -kInf, 1e308, -1e308, 5e-324, -0.0, 1e5, 9.9e4};
  return kinds[static_cast<int>(random.uniform() * 9) % 9];
}

TEST(SafeForceStreams, NeverLeaveTheirLimits) {
  Random random(1);
  long samples = 0, cut = 0, untouched = 0, zeros = 0;
  for (int stream = 0; stream < 400; ++stream) {
    const SafetyLimits limits = limits_of_a_box(random);
    SafeForce safe(limits);
    Vec3 x = Vec3::Zero(), wanted = Vec3::Zero(), before = Vec3::Zero();
    double t = 1e4 * random.uniform(), t_before = t - 1e-3, t_valid = -kInf;
    bool begun = false;
    const double wild = random.uniform();  // how bad this stream is
    for (int i = 0; i < 2000; ++i) {
      // Time: mostly a period, sometimes none, a pause, or a clock that has been set.
      const double chance = random.uniform();
      if (chance > 0.02 * wild) t += 1e-3 * (0.2 + 1.6 * random.uniform());
      if (chance < 0.004 * wild) t += 3 * random.uniform();
      double told = t;
      if (chance > 0.03 && chance < 0.03 + 0.005 * wild) told = t - random.uniform();
      if (chance > 0.04 && chance < 0.04 + 0.002 * wild) told = i % 2 == 0 ? std::nan("") : kInf;
      x += 1e-3 * Vec3(random.normal(), random.normal(), random.normal());
      wanted += 0.05 * limits.force * Vec3(random.normal(), random.normal(), random.normal());
      if (random.uniform() < 0.01) wanted *= 0.1;
      if (random.uniform() < 0.002) x.setZero();
      Vec3 force = wanted, place = x;
      if (random.uniform() < 0.03 * wild) force[i % 3] = any_double(random);
      if (random.uniform() < 0.03 * wild) place[i % 3] = any_double(random);
      if (random.uniform() < 0.01 * wild) force *= 1e4;
      const bool missing = random.uniform() < 0.3 * wild;
      const SafeSample s = missing ? safe.miss(told) : safe.pass(told, place, force);
      ++samples;
      const double now = std::isfinite(told) ? std::max(t_before, told) : t_before;
      ASSERT_TRUE(s.force.allFinite());
      ASSERT_TRUE(s.unlimited.allFinite());
      ASSERT_LE(s.force.norm(), limits.force * (1 + 1e-12));
      // The first sample has a period.
      const double passed = begun ? now - t_before : std::max(1e-3, now - t_before);
      ASSERT_LE((s.force - before).norm(), limits.rate * passed + 1e-9 * limits.force)
          << "stream " << stream << " sample " << i;
      const bool valid = !missing && (s.flags & kSafeInvalid) == 0;
      if (valid) t_valid = now;
      begun = begun || valid;
      if (!valid && now > t_valid + limits.hold + limits.ramp) {
        ASSERT_EQ(s.force, Vec3(0, 0, 0));
        ++zeros;
      }
      if (!valid) {
        ASSERT_NE(s.flags & (kSafeHeld | kSafeRamped), 0);
        ASSERT_LE(s.force.norm(), before.norm() * (1 + 1e-12)) << "nothing new makes no force";
      }
      if (valid && s.flags == 0) {
        ASSERT_EQ(std::memcmp(s.force.data(), force.data(), sizeof(double) * 3), 0);
        ASSERT_LE(force.norm(), limits.force);
        ASSERT_TRUE(limits.contains(place));
        ++untouched;
      }
      if (valid && s.flags != 0) {
        ASSERT_NE(s.force, force);
        ASSERT_EQ(s.unlimited, force) << "what was cut stands beside it";
        ++cut;
      }
      before = s.force;
      t_before = now;
    }
  }
  // The streams do visit all of this.
  EXPECT_GT(cut, 10000);
  EXPECT_GT(untouched, 10000);
  EXPECT_GT(zeros, 100);
}

// A recording that stays within the limits comes through bit for bit, whatever they are.
TEST(SafeForceStreams, WithinTheLimitsNothingIsTouched) {
  Random random(2);
  for (int stream = 0; stream < 100; ++stream) {
    SafetyLimits limits = limits_of_a_box(random);
    limits.power = kInf;
    SafeForce safe(limits);
    const double size = 0.5 * limits.force * random.uniform(), speed = limits.rate / limits.force;
    for (int i = 0; i < 1000; ++i) {
      const double t = 1e-3 * i, s = std::sin(0.9 * speed * t);
      const Vec3 force(0.3 * size * s, -0.2 * size * s, size * s);
      const SafeSample sample = safe.pass(t, Vec3::Zero(), force);
      ASSERT_EQ(sample.flags, 0);
      ASSERT_EQ(std::memcmp(sample.force.data(), force.data(), sizeof(double) * 3), 0);
    }
  }
}

}  // namespace
}  // namespace hapsim
