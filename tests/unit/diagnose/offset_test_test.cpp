// Offsets of presses: seldom found in noise, not found in wrong stiffnesses, found when there.
#include "diagnose/offset_test.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// Twelve presses of 60 samples, in and out, at four places.
Dataset twelve_presses() {
  Dataset d;
  for (int p = 0; p < 12; ++p) {
    Episode e;
    e.position = p % 4;
    e.view.normal = Vec3(0.1 * (p % 4), 0.2, 1).normalized();
    for (int i = 0; i < 60; ++i) {
      e.rows.push_back(60 * p + i);
      e.view.u.push_back(-0.003 * std::sin(M_PI * i / 59.0) * e.view.normal);
      e.view.in_air.push_back(0);
    }
    d.episodes.push_back(e);
  }
  return d;
}

struct Case {
  Dataset dataset = twelve_presses();
  Eigen::VectorXd forces, residual;
};

// Forces of 200 N/m; the residual is noise of 1 (an autoregression of first order by `memory`), a
// relative stiffness error, and offsets.
Case make_case(std::uint64_t seed, double stiffness_error, double offset, double memory = 0) {
  Case c;
  Random random(seed);
  c.forces.resize(3 * 60 * 12);
  c.residual.resize(c.forces.size());
  Eigen::Index at = 0;
  for (const Episode& e : c.dataset.episodes) {
    Eigen::Matrix3d error = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) error(i, j) = error(j, i) = stiffness_error * random.normal();
    const Vec3 b = offset * Vec3(random.normal(), random.normal(), random.normal());
    Vec3 noise = Vec3::Zero();
    for (std::size_t i = 0; i < e.view.size(); ++i, at += 3) {
      const Vec3 fresh(random.normal(), random.normal(), random.normal());
      noise = i == 0 ? fresh : Vec3(memory * noise + std::sqrt(1 - memory * memory) * fresh);
      const Vec3 f = -200 * e.view.u[i];
      c.forces.segment<3>(at) = f;
      c.residual.segment<3>(at) = error * f / 0.01 + b + noise;
    }
  }
  return c;
}

TEST(OffsetTest, KeepsItsLevelInNoiseAndWrongStiffnesses) {
  int found = 0;
  double gain = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Case c = make_case(seed, 0.2, 0);
    const OffsetTest test = test_offsets(c.dataset, c.residual, c.forces);
    found += test.p_value < 0.05;
    gain += test.gain / 200;
  }
  std::printf("below 0.05 in %d of 200; mean gain %.1f for 36 offsets\n", found, gain);
  EXPECT_LE(found, 18);
  EXPECT_NEAR(gain, 36, 4);
}

// Samples that go together for up to a stretch are no offsets.
TEST(OffsetTest, KeepsItsLevelWhereNoiseHasAMemory) {
  for (const double memory : {0.5, 0.7, 0.8}) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const Case c = make_case(seed, 0.2, 0, memory);
      found += test_offsets(c.dataset, c.residual, c.forces).p_value < 0.05;
    }
    std::printf("memory %.1f: below 0.05 in %d of 200\n", memory, found);
    EXPECT_LE(found, 18);
  }
}

TEST(OffsetTest, FindsOffsetsOfTheNoisesSize) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Case c = make_case(seed, 0.2, 1);
    EXPECT_LT(test_offsets(c.dataset, c.residual, c.forces).p_value, 1e-4) << seed;
  }
}

}  // namespace
}  // namespace hapsim
