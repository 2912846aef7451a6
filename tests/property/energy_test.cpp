// However hand and force go, a hand gets no more energy than the bound says; who owes none is not
// touched.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "base/random.h"
#include "safety/safe_force.h"

namespace hapsim {
namespace {

constexpr double kPeriod = 1e-3;

SafetyLimits limits_with_energy(Random& random) {
  SafetyLimits limits;
  limits.force = std::pow(10, 2 * random.uniform() - 0.5);
  limits.ramp = 0.02 + 0.3 * random.uniform();
  limits.rate = limits.force / limits.ramp * (1 + 30 * random.uniform());
  limits.power = std::pow(10, 3 * random.uniform() - 1);
  limits.speed = 0.2 + random.uniform();
  limits.damping = 2 * random.uniform();
  if (random.uniform() < 0.5) limits.energy = std::pow(10, -3 + 2 * random.uniform());
  return limits;
}

Vec3 any_direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

// A hand no faster than `speed` that does what it likes: it rests, wanders, flees with the force or
// comes against it.
struct Hand {
  Vec3 step(Random& random, const Vec3& force, double speed) {
    if (random.uniform() < 0.01) mood = static_cast<int>(random.integer(4));
    if (random.uniform() < 0.02) way = any_direction(random);
    const double size = force.norm();
    Vec3 v = mood == 0 ? Vec3(Vec3::Zero()) : Vec3(way * speed * random.uniform());
    if (mood >= 2 && size > 0) v = (mood == 2 ? 1 : -0.3) * speed / size * force;
    return v * kPeriod;
  }
  int mood = 1;
  Vec3 way{0, 0, 1};
};

TEST(EnergyStreams, AHandNeverGetsMoreThanTheBound) {
  Random random(21);
  long touched = 0, whole = 0, owing = 0;
  double fullest = 0;
  for (int stream = 0; stream < 600; ++stream) {
    const SafetyLimits limits = limits_with_energy(random);
    SafeForce safe(limits, kPeriod);
    const double bound = limits.energy_bound(kPeriod);
    Hand hand;
    Vec3 x = Vec3::Zero(), wanted = Vec3::Zero(), before = Vec3::Zero(), way = Vec3::Zero();
    double work = 0, taken = 0, t = 100;
    double lowest = 0;  // of work less what the damping took since then: since any moment
    double stored = 0, strongest = 0, farthest = 0;
    Vec3 origin = x;
    const double kind = random.uniform();
    for (int i = 0; i < 3000; ++i, t += kPeriod) {
      x += way;
      const double given = before.dot(way);
      work += given;
      taken += limits.damping * way.squaredNorm() / kPeriod;
      const double net = work - taken;
      lowest = std::min(lowest, net);
      ASSERT_LE(net, bound * (1 + 1e-9) + 1e-12) << "stream " << stream << " sample " << i;
      farthest = std::max(farthest, (x - origin).norm());
      stored = strongest * farthest;
      ASSERT_LE(net - lowest, bound + stored + 1e-9) << "since any moment of the press";
      fullest = std::max(fullest, net / bound);
      // What is asked for: late, active, leaping, or a spring.
      if (kind < 0.3)
        wanted = 0.9 * wanted + limits.force * any_direction(random);
      else if (kind < 0.6)
        wanted = way * (random.uniform() * limits.force / (limits.speed * kPeriod));
      else
        wanted = -random.uniform() * 1000 * (x - (random.uniform() < 0.1 ? 0.01 : 0) * before);
      const double chance = random.uniform();
      SafeSample s;
      if (chance < 0.05) {
        s = safe.pass(t, x, wanted * std::nan(""));
      } else if (kind > 0.8 && i % 700 > 500) {
        s = safe.pass(t, x, wanted, 100 + kPeriod * (i - i % 700 + 500));  // the peer is silent
      } else {
        s = safe.pass(t, x, wanted);
        if (s.flags == 0) {
          ++whole;
          ASSERT_EQ(std::memcmp(s.force.data(), wanted.data(), sizeof(double) * 3), 0);
        }
      }
      touched += (s.flags & kSafeEnergy) != 0 ? 1 : 0;
      owing += safe.energy().reserve() < 0 ? 1 : 0;
      ASSERT_LE(s.force.norm(), limits.force * (1 + 1e-12));
      ASSERT_LE((s.force - before).norm(), limits.rate * kPeriod * (1 + 1e-9) + 1e-12);
      ASSERT_NEAR(safe.energy().given(), work, 1e-9 * (1 + std::abs(work)));
      strongest = std::max(strongest, s.force.norm());
      before = s.force;
      way = hand.step(random, before, limits.speed);
    }
  }
  // The streams do visit all of this.
  EXPECT_GT(touched, 100'000);
  EXPECT_GT(whole, 10'000);
  EXPECT_GT(owing, 100'000);
  EXPECT_GT(fullest, 0.5);
}

// Without it they do get more: the test has teeth.
TEST(EnergyStreams, WithoutItAHandGetsMore) {
  Random random(22);
  int over = 0;
  for (int stream = 0; stream < 50; ++stream) {
    const SafetyLimits limits = limits_with_energy(random);
    SafeForce safe(of_any_energy(limits), kPeriod);
    Vec3 x = Vec3::Zero(), way(1e-5, 0, 0);
    double work = 0;
    for (int i = 0; i < 3000; ++i) {
      x += way;
      const Vec3 f = safe.pass(kPeriod * i, x, way * 1e5).force;
      if (f.norm() > 0) way = limits.speed * kPeriod * f.normalized();
      work += f.dot(way);
    }
    over += work > limits.energy_bound(kPeriod);
  }
  EXPECT_GT(over, 40);
}

// A body that is passive between its samples, too: K T / 2 is at most the damping of hand and
// device.
TEST(EnergyStreams, APassiveBodyIsNotTouched) {
  Random random(23);
  for (int stream = 0; stream < 200; ++stream) {
    SafetyLimits limits;
    limits.damping = 0.1 + 2 * random.uniform();
    SafeForce safe(limits, kPeriod);
    const double K = 2 * limits.damping / kPeriod * (0.05 + 0.95 * random.uniform());
    const double b = stream % 2 == 0 ? 0 : 5 * random.uniform();  // a dashpot in series
    const double deep = 0.5 * std::min(limits.force / K, 0.02);
    const Vec3 axis = any_direction(random), aside = any_direction(random);
    const double w1 = 3 + 12 * random.uniform(), w2 = 1 + 9 * random.uniform();
    Vec3 branch = Vec3::Zero();
    double tau = 0.05 + random.uniform();
    for (int i = 0; i < 20'000; ++i) {
      const double t = kPeriod * i;
      const Vec3 u = deep * (std::sin(w1 * t) * axis + 0.3 * std::sin(w2 * t) * aside);
      branch += kPeriod / tau * (u - branch);
      const Vec3 wanted = -K / (1 + b) * (u + b * (u - branch));
      const SafeSample s = safe.pass(t, u, wanted);
      ASSERT_EQ(s.flags, 0) << "stream " << stream << " sample " << i << " reserve "
                            << safe.energy().reserve();
      ASSERT_EQ(std::memcmp(s.force.data(), wanted.data(), sizeof(double) * 3), 0);
    }
  }
}

// What a press has put in is not given in the next one; what is owed stays owed.
TEST(EnergyStreams, APressDoesNotPayForTheNext) {
  SafetyLimits limits;
  limits.energy = 0.01;
  limits.damping = 0;
  SafeForce safe(limits, kPeriod);
  double x = 0, t = 0;
  const auto go = [&](double by, double force) {
    t += kPeriod;
    x += by;
    return safe.pass(t, {0, 0, x}, {0, 0, force});
  };
  for (int i = 0; i < 100; ++i) go(-1e-4, 2);
  EXPECT_NEAR(safe.energy().reserve(), 0.02, 1e-3);
  safe.begin_press();
  EXPECT_EQ(safe.energy().reserve(), 0);
  for (int i = 0; i < 300; ++i) go(1e-4, 2);
  const double owed = safe.energy().reserve();
  EXPECT_LT(owed, -1e-3);
  EXPECT_GE(owed, -0.01);
  safe.begin_press();
  EXPECT_EQ(safe.energy().reserve(), owed);
}

}  // namespace
}  // namespace hapsim
