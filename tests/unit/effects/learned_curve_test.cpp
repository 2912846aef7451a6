#include "effects/learned_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "effects/catalogue.h"

namespace hapsim {
namespace {

constexpr std::size_t kKnots = 6;
using Curve = LearnedCurve<kKnots>;
constexpr Curve kCurve({0, 0.2, 0.45, 0.6, 0.8, 1});

double value(const std::array<double, kKnots>& y, double x, double* slope = nullptr) {
  Curve::Weights w, s;
  kCurve.at(x, w, s);
  double sum = 0, sum_slope = 0;
  for (std::size_t k = 0; k < kKnots; ++k) sum += w[k] * y[k], sum_slope += s[k] * y[k];
  if (slope != nullptr) *slope = sum_slope;
  return sum;
}

TEST(LearnedCurve, GoesThroughItsValuesStraightBeforeAndLevelBeyond) {
  const std::array<double, kKnots> y{0.3, -0.2, 1, 0.4, 0, 2};
  for (std::size_t k = 0; k < kKnots; ++k) EXPECT_NEAR(value(y, kCurve.knots()[k]), y[k], 1e-14);
  double slope = 1;
  EXPECT_EQ(value(y, 1.5, &slope), 2);
  EXPECT_EQ(slope, 0);
  value(y, 0, &slope);
  EXPECT_NEAR(value(y, -1), 0.3 - slope, 1e-12);
}

TEST(LearnedCurve, IsTheParabolaThroughValuesOnOne) {
  std::array<double, kKnots> y{};
  for (std::size_t k = 0; k < kKnots; ++k)
    y[k] = 3 - 2 * kCurve.knots()[k] + 4 * std::pow(kCurve.knots()[k], 2);
  for (double x = 0.01; x < 1; x += 0.01) {
    double slope = 0;
    EXPECT_NEAR(value(y, x, &slope), 3 - 2 * x + 4 * x * x, 1e-13);
    EXPECT_NEAR(slope, 8 * x - 2, 1e-12);
  }
}

TEST(LearnedCurve, BendsContinuously) {
  const std::array<double, kKnots> y{0.3, -0.2, 1, 0.4, 0, 2};
  constexpr double h = 1e-5;
  const auto second = [&](double x) {
    double before = 0, after = 0;
    value(y, x - h, &before), value(y, x + h, &after);
    return (after - before) / (2 * h);
  };
  for (std::size_t k = 1; k + 1 < kKnots; ++k) {
    const double x = kCurve.knots()[k];
    EXPECT_NEAR(second(x - 2 * h), second(x + 2 * h), 0.2) << k;
  }
  for (double x = 0.013; x < 1; x += 0.05) {
    double slope = 0;
    value(y, x, &slope);
    EXPECT_NEAR((value(y, x + h) - value(y, x - h)) / (2 * h), slope, 1e-6);
  }
}

// Fourth order: halved knots leave a sixteenth of the error, at the ends an eighth.
TEST(LearnedCurve, ConvergesToASmoothCurve) {
  const auto error = [](const auto& curve) {
    double worst = 0;
    for (double x = 0; x <= 1; x += 0.003) {
      typename std::decay_t<decltype(curve)>::Weights w, s;
      curve.at(x, w, s);
      double sum = 0;
      for (std::size_t k = 0; k < w.size(); ++k) sum += w[k] * std::sin(5 * curve.knots()[k]);
      worst = std::max(worst, std::abs(sum - std::sin(5 * x)));
    }
    return worst;
  };
  const LearnedCurve<6> coarse({0, 0.2, 0.4, 0.6, 0.8, 1});
  const LearnedCurve<11> fine({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1});
  EXPECT_LT(error(fine), error(coarse) / 4);
  EXPECT_LT(error(fine), 6e-3);
}

TEST(LearnedCurve, SaysByHowMuchItMayErr) {
  const LearnedCurve<8> curve({0.04, 0.12, 0.22, 0.34, 0.48, 0.64, 0.82, 1});
  std::array<double, 8> y{};
  for (std::size_t k = 0; k < 8; ++k) y[k] = std::sin(5 * curve.knots()[k]);
  int covered = 0, points = 0;
  for (double x = 0.05; x < 1; x += 0.01, ++points) {
    LearnedCurve<8>::Weights w, s;
    curve.at(x, w, s);
    double sum = 0;
    for (std::size_t k = 0; k < 8; ++k) sum += w[k] * y[k];
    covered += std::abs(sum - std::sin(5 * x)) <= for_want_of_knots(curve, y, x) + 1e-4;
  }
  EXPECT_GE(covered, 0.9 * points);
}

// The derivatives by the effect's values, from which the band is made.
TEST(EffectCurves, HaveTheDerivativesOfTheirPoints) {
  for (const Effect* effect : catalogue()) {
    if (!effect->card().learned) continue;
    Values values;
    double v = 0.03;
    for (const ParameterCard& p : effect->card().parameters)
      values.push_back({0, p.name, p.fixed ? p.start : (v = -0.8 * v), -1});
    const std::vector<EffectCurve> curves = effect->curves(values);
    EXPECT_FALSE(curves.empty()) << effect->card().name;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (effect->card().parameters[k].fixed) continue;
      Values more = values, less = values;
      more[k].value += 1e-6, less[k].value -= 1e-6;
      const std::vector<EffectCurve> up = effect->curves(more), down = effect->curves(less);
      for (std::size_t c = 0; c < curves.size(); ++c)
        for (std::size_t i = 0; i < curves[c].points.size(); ++i)
          EXPECT_NEAR((up[c].points[i].y - down[c].points[i].y) / 2e-6,
                      curves[c].points[i].by[static_cast<Eigen::Index>(k)], 1e-7)
              << effect->card().name << " " << values[k].name;
    }
  }
}

}  // namespace
}  // namespace hapsim
