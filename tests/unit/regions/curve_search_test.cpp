// A curve of any shape between two regions: the level that is 0 on it, and where presses say it is.
#include "regions/curve_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "regions/region_boundary.h"

namespace hapsim {
namespace {

using CurvePlan = Eigen::Vector2d;

std::vector<CurvePlan> scattered(Random& random, int rows) {
  std::vector<CurvePlan> result;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < rows; ++j)
      result.emplace_back(0.02 * (i + 1) + 0.008 * (random.uniform() - 0.5),
                          0.02 * (j + 1) + 0.008 * (random.uniform() - 0.5));
  return result;
}

TEST(PlanLevel, GoesThroughItsKnotsAndKnowsItsSlope) {
  Random random(3);
  const std::vector<CurvePlan> knots = scattered(random, 5);
  const PlanLevel level(knots, 100);
  ASSERT_EQ(level.size(), 25);
  Eigen::VectorXd values(25);
  for (double& v : values) v = 0.01 * random.normal();
  const Eigen::VectorXd theta = level.fitted(knots, values, 0);
  for (int i = 0; i < 25; ++i)
    EXPECT_NEAR(level.value(knots[static_cast<std::size_t>(i)], theta), values[i], 1e-6);
  const CurvePlan p(0.047, 0.061);
  const double h = 1e-6;
  const Eigen::Vector2d slope = level.slope(p) * theta;
  for (int c = 0; c < 2; ++c) {
    const CurvePlan step = h * CurvePlan::Unit(c);
    EXPECT_NEAR(slope[c], (level.value(p + step, theta) - level.value(p - step, theta)) / (2 * h),
                1e-5);
  }
}

TEST(PlanLevel, IsAPlaneWhereNothingBendsIt) {
  Random random(4);
  const std::vector<CurvePlan> knots = scattered(random, 5);
  const PlanLevel level(knots, 10);
  Eigen::VectorXd values(25);
  for (int i = 0; i < 25; ++i) values[i] = 0.3 * knots[static_cast<std::size_t>(i)].x() - 0.01;
  const Eigen::VectorXd theta = level.fitted(knots, values, 1e-3);
  EXPECT_LT(theta.tail(10).norm(), 1e-3);
  EXPECT_NEAR(level.value({0.3, -0.2}, theta), 0.08, 1e-5);
  const PlanLevel::Distance off = level.distance({0.05, 0.02}, theta);
  EXPECT_NEAR(off.value, 0.05 - 0.01 / 0.3, 1e-5) << "over its slope it is the distance";
}

TEST(SmoothStep, HasItsSlope) {
  for (const double d : {-0.9e-3, -0.2e-3, 0.0, 0.7e-3}) {
    const double h = 1e-9;
    EXPECT_NEAR(smooth_step(d, 2e-3).slope,
                (smooth_step(d + h, 2e-3).value - smooth_step(d - h, 2e-3).value) / (2 * h), 1e-2);
  }
  EXPECT_EQ(smooth_step(-2e-3, 2e-3).value, 0);
  EXPECT_EQ(smooth_step(2e-3, 2e-3).value, 1);
}

// Presses on a half-space of an energy that falls like the fourth power beyond the tool's rim.
struct PressedCurve {
  PlanGrid grid;
  std::vector<LocationSample> samples;
  std::vector<std::vector<float>> share;

  template <typename Inside>
  PressedCurve(const Inside& inside, double ratio, Random& random) {
    grid.columns = 60;
    grid.rows = 80;
    grid.step_x = grid.step_y = 2e-3;
    for (const CurvePlan& place : scattered(random, 7)) {
      double sum = 0, in = 0;
      std::vector<double> energy;
      for (int c = 0; c < grid.columns * grid.rows; ++c) {
        const CurvePlan p = grid.centre(c).head<2>();
        energy.push_back(1 / (1 + std::pow((p - place).norm() / 0.004, 4)));
        sum += energy.back();
        if (inside(p)) in += energy.back();
      }
      share.emplace_back();
      for (const double e : energy) share.back().push_back(static_cast<float>(e / sum));
      const double gain = std::exp(in / sum * std::log(ratio) + 0.01 * random.normal());
      samples.push_back(
          {static_cast<int>(samples.size()), {place.x(), place.y(), 0.04}, gain, 0.01 * gain});
    }
  }
};

TEST(FindCurve, AnSIsFoundWithoutANumber) {
  Random random(11);
  const auto height = [](double x) { return 0.08 + 0.018 * std::sin(52 * x); };
  const PressedCurve pressed([&](const CurvePlan& p) { return p.y() > height(p.x()); }, 2, random);
  const auto found = find_boundary(pressed.samples, pressed.share, pressed.grid);
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::exp(found->log_gain[0]), 1, 0.03);
  EXPECT_NEAR(std::exp(found->log_gain[1]), 2, 0.06);
  double squares = 0;
  int count = 0;
  for (double x = 0.02; x <= 0.1; x += 0.002, ++count) {
    double low = 0.02, high = 0.14;  // where it crosses, along y
    for (int k = 0; k < 20; ++k)
      (found->side({x, 0.5 * (low + high)}) == 1 ? high : low) = 0.5 * (low + high);
    squares += std::pow(low - height(x), 2);
  }
  const double off = std::sqrt(squares / count);
  std::printf("off by %.2f mm along y\n", 1e3 * off);
  EXPECT_LT(off, 3e-3);
  EXPECT_LT(found->criterion,
            region_labels(pressed.samples, kAutomaticRegions, 8).criterion + kStrongEvidence)
      << "rather than groups of like moduli";
}

// What more may bend is not believed where a straight line is.
TEST(FindCurve, AStraightOneStaysStraight) {
  Random random(12);
  const PressedCurve pressed([](const CurvePlan& p) { return p.y() > 0.075; }, 2, random);
  const auto found = find_boundary(pressed.samples, pressed.share, pressed.grid);
  ASSERT_TRUE(found);
  EXPECT_LT(found->keys, 10) << "one of few parameters";
}

TEST(FindCurve, TooFewPlacesAndOneLineTellNone) {
  Random random(13);
  PressedCurve pressed([](const CurvePlan& p) { return p.y() > 0.075; }, 2, random);
  PressedCurve line = pressed;
  for (LocationSample& s : line.samples) s.point.x() = 0.05;
  EXPECT_FALSE(find_curve(line.samples, line.share, line.grid));
  pressed.samples.resize(5);
  pressed.share.resize(5);
  EXPECT_FALSE(find_curve(pressed.samples, pressed.share, pressed.grid));
}

}  // namespace
}  // namespace hapsim
