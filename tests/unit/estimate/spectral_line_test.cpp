// Lines in series of presses with gaps between them.
#include "estimate/spectral_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/random.h"

namespace hapsim {
namespace {

struct Series {
  std::vector<double> t;
  std::vector<Vec3> values;
};

// Presses of 3 s, 50 samples a second, at odd times; noise of deviation 1.
Series presses(int count, Random& random,
               const std::function<Vec3(double session, double press)>& wave) {
  Series s;
  double start = 0;
  for (int p = 0; p < count; ++p) {
    for (int i = 0; i < 150; ++i) {
      s.t.push_back(start + 0.02 * i);
      s.values.push_back(Vec3(random.normal(), random.normal(), random.normal()) +
                         wave(s.t.back(), 0.02 * i));
    }
    start += 20 + 30 * random.uniform();
  }
  return s;
}

TEST(SpectralLine, IsFoundInItsComponents) {
  Random random(1);
  for (const double f : {0.07, 0.31, 4.7}) {
    const Series s = presses(40, random, [f](double t, double) -> Vec3 {
      return Vec3(0, 0.3, 0.5) * std::sin(2 * M_PI * f * t + 0.4);
    });
    const SpectralLine line = find_line(s.t, s.values, 40);
    EXPECT_NEAR(line.frequency, f, line.resolution);
    EXPECT_LT(line.resolution, 1e-3);
    EXPECT_NEAR(std::hypot(line.sine.z(), line.cosine.z()), 0.5, 0.25);
    EXPECT_LT(std::hypot(line.sine.x(), line.cosine.x()), 0.1);
  }
}

TEST(SpectralLine, IsFoundInOnePress) {
  Random random(2);
  const Series s = presses(
      1, random, [](double t, double) { return Vec3(0, 0, 2 * std::sin(2 * M_PI * 3 * t)); });
  EXPECT_NEAR(find_line(s.t, s.values, 1).frequency, 3, 0.4);
}

TEST(SpectralLine, IsNoneOfNoise) {
  Random random(3);
  const auto none = [](double, double) { return Vec3(0, 0, 0); };
  int found = 0;
  for (int draw = 0; draw < 20; ++draw) {
    const Series s = presses(draw % 2 == 0 ? 40 : 2, random, none);
    found += find_line(s.t, s.values, draw % 2 == 0 ? 40 : 2).frequency > 0 ? 1 : 0;
  }
  EXPECT_EQ(found, 0);
}

// What a relaxation leaves of each press, ten times the noise: broad power, and no line.
TEST(SpectralLine, IsNoneOfWhatEachPressLeaves) {
  Random random(4);
  for (int draw = 0; draw < 10; ++draw) {
    const Series s = presses(40, random, [](double, double press) {
      return Vec3(0, 0, 20 * std::exp(-press / 0.4) - 4);
    });
    EXPECT_EQ(find_line(s.t, s.values, 40).frequency, 0);
  }
}

TEST(SpectralLine, NeedsASeriesInTime) {
  EXPECT_EQ(find_line({}, {}, 0).frequency, 0);
  EXPECT_EQ(
      find_line(std::vector<double>(200, 1.0), std::vector<Vec3>(200, Vec3::UnitZ()), 1).frequency,
      0);
}

}  // namespace
}  // namespace hapsim
