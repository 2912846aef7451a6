#include "recording/force_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/random.h"

namespace hapsim {
namespace {

struct Presses {
  int count = 20, rows = 60;
  double air = 0;             // share of the rows at either end, up to 3 mm off the contact
  Vec3 line = Vec3::UnitZ();  // of the force
  bool back = true;           // the way back belongs to the press
};

// Presses to 5 mm, with forces of 1 N at the deepest; `noise` adds what a sensor does.
Recording presses(const Presses& p, const std::function<Vec3(int press, const Vec3& f)>& sensor) {
  Recording r;
  for (int k = 0; k < p.count; ++k)
    for (int i = 0; i < p.rows; ++i) {
      const double time = (i + 0.5) / p.rows;
      const double way = p.back ? 1 - std::abs(2 * time - 1) : time;
      const double depth =
          p.air > 0 ? (way < p.air ? -3e-3 * (1 - way / p.air) : 5e-3 * (way - p.air) / (1 - p.air))
                    : 5e-3 * way;
      r.press.push_back(k + 1);
      r.position.emplace_back(0.01 * k, 0, 0.05);
      r.u.push_back(-depth * p.line);
      r.f.push_back(sensor(k, std::pow(std::max(0.0, depth) / 5e-3, 1.5) * p.line));
    }
  return r;
}

Vec3 white(Random& random, double sigma) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return sigma * Vec3(x, y, z);
}

double rounded(double v, double step) {
  return step * std::round(v / step);
}

TEST(ForceNoise, OfThreeAxesIsThatOfOneComponent) {
  Random random(1);
  for (const double sigma : {1e-4, 0.003, 0.05}) {
    const NoiseEstimate noise = measure_force_noise(presses(
        {.rows = 400}, [&](int, const Vec3& f) -> Vec3 { return f + white(random, sigma); }));
    EXPECT_NEAR(noise.sigma / sigma, 1, 0.03) << sigma;
    EXPECT_EQ(noise.along, noise.sigma);
    EXPECT_EQ(noise.how, "second differences of 20 presses");
    EXPECT_EQ(noise.differences, 20u * 398);
  }
}

// The formula to the letter.
TEST(ForceNoise, IsTheMedianOfSecondDifferences) {
  Random random(2);
  const Recording r = presses({.count = 1, .rows = 20},
                              [&](int, const Vec3& f) -> Vec3 { return f + white(random, 0.01); });
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> sizes;
    for (std::size_t i = 1; i + 1 < r.rows(); ++i)
      sizes.push_back(std::abs(r.f[i - 1][k] - 2 * r.f[i][k] + r.f[i + 1][k]));
    std::sort(sizes.begin(), sizes.end());
    sum += std::pow(sizes[sizes.size() / 2] / (0.6745 * std::sqrt(6.0)), 2);
  }
  EXPECT_DOUBLE_EQ(measure_force_noise(r).sigma, std::sqrt(sum / 3));
}

// Sensors differ by axis. Errors are pooled over the components, as root mean squares.
TEST(ForceNoise, OfUnequalAxesIsTheirRootMeanSquare) {
  Random random(10);
  const auto sensor = [&](int, const Vec3& f) -> Vec3 {
    const Vec3 n = white(random, 1);
    return f + Vec3(0.003 * n.x(), 0.004 * n.y(), 0.02 * n.z());
  };
  const double truth = std::sqrt((0.003 * 0.003 + 0.004 * 0.004 + 0.02 * 0.02) / 3);
  EXPECT_NEAR(measure_force_noise(presses({}, sensor)).sigma / truth, 1, 0.05);
  EXPECT_NEAR(
      measure_force_noise(presses({.count = 200, .rows = 10, .back = false}, sensor)).sigma / truth,
      1, 0.1);
}

// Axes that were not measured are zero and say nothing.
TEST(ForceNoise, OfOneAndTwoAxesIsNotThinnedByTheOthers) {
  Random random(3);
  const double one = measure_force_noise(presses({}, [&](int, const Vec3& f) -> Vec3 {
                       return {0, 0, (f + white(random, 0.01)).z()};
                     })).sigma;
  EXPECT_NEAR(one, 0.01, 0.0006);
  const double two = measure_force_noise(presses({}, [&](int, const Vec3& f) -> Vec3 {
                       const Vec3 n = white(random, 0.01);
                       return {n.x(), 0, f.z() + n.z()};
                     })).sigma;
  EXPECT_NEAR(two, 0.01, 0.0006);
}

// A load cell of one axis on a curved body: its noise is that of the force along the press, and its
// share in a component is what an error of the fit, pooled over components, is compared with.
TEST(ForceNoise, AlongTheNormalOfACurvedBodyIsPooledOverTheComponents) {
  Random random(4);
  Recording all;
  double squares = 0;
  for (int k = 0; k < 40; ++k) {
    const Vec3 line = Vec3(std::cos(k), std::sin(k), 0.3 + 0.02 * k).normalized();
    const Recording one = presses({.count = 1, .line = line}, [&](int, const Vec3& f) -> Vec3 {
      const double n = 0.01 * random.normal();
      squares += n * n;
      return f + n * line;
    });
    all.press.insert(all.press.end(), one.rows(), k);
    all.u.insert(all.u.end(), one.u.begin(), one.u.end());
    all.f.insert(all.f.end(), one.f.begin(), one.f.end());
  }
  const NoiseEstimate noise = measure_force_noise(all);
  EXPECT_NEAR(noise.along, 0.01, 0.0005);
  EXPECT_NEAR(noise.sigma, std::sqrt(squares / (3.0 * static_cast<double>(all.rows()))), 0.0003);
}

// Steps coarser than the noise leave ties, and rounding is an error of its own: q / sqrt 12.
TEST(ForceNoise, OfRoundedForcesIncludesTheRounding) {
  Random random(5);
  constexpr double kStep = 0.01;
  for (const double share : {0.0, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0}) {
    const Recording r = presses({.rows = 200}, [&](int, const Vec3& f) -> Vec3 {
      return {0, 0, rounded(f.z() + share * kStep * random.normal(), kStep)};
    });
    const double truth = kStep * std::hypot(share, 1 / std::sqrt(12.0));
    EXPECT_NEAR(measure_force_noise(r).sigma / truth, 1, 0.15) << share;
  }
}

// Steps in another unit, and of three axes.
TEST(ForceNoise, StepsNeedNotBeDecimal) {
  Random random(6);
  constexpr double kStep = 0.00980665;  // a gram
  const Vec3 line = Vec3(0.5, 0.6, 0.7).normalized();
  const Recording r = presses({.rows = 200, .line = line}, [&](int, const Vec3& f) -> Vec3 {
    const Vec3 n = f + 0.2 * white(random, kStep);
    return {rounded(n.x(), kStep), rounded(n.y(), kStep), rounded(n.z(), kStep)};
  });
  const double truth = kStep * std::hypot(0.2, 1 / std::sqrt(12.0));
  EXPECT_NEAR(measure_force_noise(r).sigma / truth, 1, 0.3);
}

// Few rows a press: the force bends between neighbours, third differences feel it less.
TEST(ForceNoise, OfShortPressesIsNotTheBendOfTheForce) {
  for (const int rows : {4, 5, 8, 12, 19}) {
    Random random(7);
    const NoiseEstimate noise = measure_force_noise(
        presses({.count = 200, .rows = rows, .back = false},
                [&](int, const Vec3& f) -> Vec3 { return f + white(random, 0.01); }));
    EXPECT_NEAR(noise.sigma, 0.01, 0.001) << rows;
    EXPECT_EQ(noise.how, "third differences of 200 presses");
  }
}

TEST(ForceNoise, SlowNoiseIsSeenInTheAir) {
  Random random(8);
  double slow = 0, x = 0;
  const auto sensor = [&](int, const Vec3& f) -> Vec3 {
    slow = 0.95 * slow + std::sqrt(1 - 0.95 * 0.95) * 0.01 * random.normal();
    x = 0.95 * x + std::sqrt(1 - 0.95 * 0.95) * 0.01 * random.normal();
    return f + Vec3(x, 0, slow);
  };
  EXPECT_LT(measure_force_noise(presses({.count = 40, .rows = 200}, sensor)).sigma, 0.003);
  const NoiseEstimate seen =
      measure_force_noise(presses({.count = 40, .rows = 200, .air = 0.4}, sensor));
  EXPECT_NEAR(seen.sigma, 0.01, 0.002);
  EXPECT_EQ(seen.how, "the samples in the air of 40 presses");
}

// What the air says of white noise is chance, and changes nothing.
TEST(ForceNoise, WhiteNoiseIsMeasuredByDifferencesAirOrNot) {
  int by_air = 0;
  for (int seed = 0; seed < 50; ++seed) {
    Random random(100 + static_cast<std::uint64_t>(seed));
    const NoiseEstimate noise =
        measure_force_noise(presses({.count = 4, .air = 0.4}, [&](int, const Vec3& f) -> Vec3 {
          return f + white(random, 0.01);
        }));
    EXPECT_NEAR(noise.sigma, 0.01, 0.003);
    by_air += noise.how.find("air") != std::string::npos ? 1 : 0;
  }
  EXPECT_LE(by_air, 3);
}

TEST(ForceNoise, WithoutAnyIsASmallShareOfTheForce) {
  const Recording r = presses({.count = 2}, [](int, const Vec3& f) -> Vec3 {
    return f.z() > 0.5 ? Vec3(0, 0, 1) : Vec3(Vec3::Zero());
  });
  EXPECT_GT(measure_force_noise(r).sigma, 0);
  Recording flat = r;
  for (Vec3& f : flat.f) f = Vec3(0, 0, 1);
  EXPECT_DOUBLE_EQ(measure_force_noise(flat).sigma, 1e-4);
}

TEST(ForceNoise, OfTooFewRowsIsUnknown) {
  Recording r;
  r.press = {1, 1};
  r.u = {Vec3::Zero(), Vec3::Zero()};
  r.f = {Vec3(0, 0, 1), Vec3(0, 0, 2)};
  EXPECT_EQ(measure_force_noise(r).sigma, 0);
  EXPECT_DOUBLE_EQ(force_noise(r).value, 2e-4);  // a fit needs some
}

TEST(ForceNoise, DeclaredIsNotMeasured) {
  Random random(9);
  Recording r = presses({}, [&](int, const Vec3& f) -> Vec3 { return f + white(random, 0.01); });
  EXPECT_TRUE(force_noise(r).measured);
  r.metadata.set("force_noise", "0.5");
  EXPECT_FALSE(force_noise(r).measured);
  EXPECT_EQ(force_noise(r).value, 0.5);
  EXPECT_EQ(force_noise(r).origin, "declared");
  r.metadata.set("force_noise_from", "third differences of 4 presses");
  EXPECT_EQ(force_noise(r).origin, "estimated from third differences of 4 presses");
  forget_force_noise(r.metadata);
  EXPECT_EQ(force_noise(r).origin, "measured from the data");
  r.metadata.set("force_noise", "0.5");
  EXPECT_EQ(force_noise(r).origin, "declared");  // nothing is left of the earlier one
}

// What a datasheet declares knows nothing of a converter's steps.
TEST(ForceNoise, StepsCountBesideWhatIsDeclared) {
  Random random(11);
  for (const double step : {0.002, 0.1, 1.0 / 30}) {
    Recording r = presses({.rows = 200}, [&](int, const Vec3& f) -> Vec3 {
      const Vec3 n = f + white(random, 0.01);
      const auto printed = [step](double v) { return rounded(rounded(v, step), 1e-4); };
      return {printed(n.x()), printed(n.y()), printed(n.z())};
    });
    r.metadata.set("force_noise", "0.01");
    const Noise noise = force_noise(r);
    const bool coarse = step > 0.01;
    const double truth = coarse ? std::hypot(0.01, step / std::sqrt(12.0)) : 0.01;
    EXPECT_NEAR(noise.value / truth, 1, 0.01) << step;
    EXPECT_NEAR(noise.step, step > 0.03 && coarse ? step : 0, 1e-3 * step) << step;
    EXPECT_EQ(noise.origin.find("steps of") != std::string::npos, coarse) << noise.origin;
    r.metadata.set("force_noise_from", "second differences");  // with the rounding in it
    EXPECT_EQ(force_noise(r).value, 0.01);
    forget_force_noise(r.metadata);
    EXPECT_NEAR(force_noise(r).step, step > 0.03 && coarse ? step : 0, 1e-3 * step) << step;
  }
}

// Forces of a model without noise differ by one amount from sample to sample, and have no steps:
// none stays while the tool moves.
TEST(ForceNoise, ASmoothRampHasNoSteps) {
  Recording r = presses({}, [](int, const Vec3& f) -> Vec3 {
    return {0, 0, std::pow(f.z(), 1 / 1.5)};
  });
  r.metadata.set("force_noise", "1e-4");
  EXPECT_EQ(force_noise(r).value, 1e-4);
}

}  // namespace
}  // namespace hapsim
