// A line of its own in each press.
#include "diagnose/press_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kWhiteNoise = 0.01;

// of(press, seconds since it began): what is left, beside noise.
template <class Left>
PressLines lines_of(const Left& of) {
  static const Experiment w = test::experiment();
  Random random(5);
  std::vector<double> residual;
  for (std::size_t e = 0; e < w.dataset.episodes.size(); ++e)
    for (const double t : w.dataset.episodes[e].view.t) {
      const Vec3 left = of(static_cast<double>(e), t);
      for (int axis = 0; axis < 3; ++axis)
        residual.push_back(left[axis] + kWhiteNoise * random.normal());
    }
  return find_press_lines(Eigen::Map<const Eigen::VectorXd>(
                              residual.data(), static_cast<Eigen::Index>(residual.size())),
                          w.dataset, kWhiteNoise);
}

TEST(PressLines, AHeartWhoseRateChangesHasThem) {
  const PressLines lines = lines_of([](double press, double t) {
    return Vec3(0.04 * std::sin(2 * M_PI * (1.5 + 0.05 * press) * t + press) * Vec3(0.3, 0, 1));
  });
  EXPECT_GT(lines.share, 0.7);
  EXPECT_NEAR(lines.slowest, 1.7, 0.15);
  EXPECT_NEAR(lines.fastest, 2.15, 0.15);
}

TEST(PressLines, NoiseHasNone) {
  EXPECT_LT(lines_of([](double, double) { return Vec3(Vec3::Zero()); }).share, 0.3);
}

// Steps and slow courses are no lines, however few samples they have.
TEST(PressLines, WhatComesOnceInAPressHasNone) {
  const auto step = [](double press, double t) {
    return Vec3(0, 0, t > 0.3 + std::fmod(0.37 * press, 1.2) ? 0.06 : 0);
  };
  EXPECT_LT(lines_of(step).share, 0.3);
  EXPECT_LT(lines_of([](double press, double t) {
              return Vec3(0, 0, 0.05 * std::exp(-t / (0.3 + 0.02 * press)));
            }).share,
            0.3);
}

}  // namespace
}  // namespace hapsim
