// Effects of the force sensor against their closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "one_press.h"

namespace hapsim {
namespace {

using test::forces_after;

// Forces of 0.2 N and more along chosen axes.
const std::vector<Vec3> kPath{{0, 0, -1e-3}, {-2e-3, 0, 0}, {0, 1e-3, -2e-3}};

TEST(SensorRotation, AQuarterTurnExchangesAxes) {
  const auto f = forces_after(sensor_rotation_effect(), test::press_along(kPath),
                              {{0, "rx", 0}, {0, "ry", M_PI / 2}, {0, "rz", 0}});
  EXPECT_NEAR((f[0] - Vec3(0.2, 0, 0)).norm(), 0, 1e-12);   // z becomes x
  EXPECT_NEAR((f[1] - Vec3(0, 0, -0.4)).norm(), 0, 1e-12);  // x becomes -z
}

TEST(SensorRotation, TurnsAboutItsVectorAndKeepsTheSize) {
  const Vec3 r(0.2, -0.1, 0.4);
  const auto f = forces_after(sensor_rotation_effect(), test::press_along({-1e-3 * r, kPath[2]}),
                              {{0, "rx", r.x()}, {0, "ry", r.y()}, {0, "rz", r.z()}});
  EXPECT_NEAR((f[0] - 0.2 * r).norm(), 0, 1e-12);
  EXPECT_NEAR(f[1].norm(), test::kStiffness * kPath[2].norm(), 1e-12);
}

TEST(SensorGain, ScalesOneAxis) {
  const auto f =
      forces_after(sensor_gain_effect(), test::press_along(kPath), {{0, "gx", 1.5}, {0, "gy", 1}});
  EXPECT_NEAR((f[1] - Vec3(0.6, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[2] - Vec3(0, -0.2, 0.4)).norm(), 0, 1e-12);
}

TEST(SensorCrosstalk, ShowsSharesOfTheOtherAxes) {
  const Values values{{0, "cxy", 0}, {0, "cxz", 0.1},  {0, "cyx", 0},
                      {0, "cyz", 0}, {0, "czx", -0.2}, {0, "czy", 0.5}};
  const auto f = forces_after(sensor_crosstalk_effect(), test::press_along(kPath), values);
  EXPECT_NEAR((f[0] - Vec3(0.02, 0, 0.2)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[1] - Vec3(0.4, 0, -0.08)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[2] - Vec3(0.04, -0.2, 0.4 - 0.1)).norm(), 0, 1e-12);
}

// In by 1 mm, held, out again: too large by 0.1 N, then too small; half of it after half of x0.
TEST(Drag, GoesAgainstTheMotion) {
  const auto f = forces_after(drag_effect(), test::press_to({0, 5e-6, 1e-3, 1e-3, 0.5e-3}),
                              {{0, "Dx", 0.3}, {0, "Dy", 0.3}, {0, "Dz", 0.1}, {0, "x0", 1e-5}});
  const double expected[] = {0, 0.001 + 0.05, 0.2 + 0.1, 0.2 + 0.1, 0.1 - 0.1};
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR((f[i] - Vec3(0, 0, expected[i])).norm(), 0, 1e-12) << i;
}

// Each axis drags by its own motion alone: x goes back while z goes on.
TEST(Drag, IsOfEachAxisAlone) {
  const auto f = forces_after(drag_effect(),
                              test::press_along({{0, 0, 0}, {1e-3, 0, -1e-3}, {0.5e-3, 0, -2e-3}}),
                              {{0, "Dx", 0.3}, {0, "Dy", 0.2}, {0, "Dz", 0.1}, {0, "x0", 1e-5}});
  const Vec3 body = -test::kStiffness * Vec3(0.5e-3, 0, -2e-3);
  EXPECT_NEAR((f[2] - body - Vec3(0.3, 0, 0.1)).norm(), 0, 1e-12);
}

TEST(SensorCurve, BendsEachAxisOddly) {
  const Values values{{0, "c2", 0.1}, {0, "c3", 0.5}, {0, "d2", -0.2}, {0, "d3", 0}};
  const auto f = forces_after(sensor_curve_effect(),
                              test::press_along({{-2e-3, 0, -1e-3}, {2e-3, 0, 1e-3}}), values);
  EXPECT_NEAR(f[0].x(), 0.4 - 0.2 * 0.16, 1e-12);
  EXPECT_NEAR(f[0].z(), 0.2 + 0.1 * 0.04 + 0.5 * 0.008, 1e-12);
  EXPECT_NEAR((f[1] + f[0]).norm(), 0, 1e-12);
}

// Halved across z where it reads the largest force, 0.8 times along it at 0.64 of that.
TEST(LearnedAxes, AcrossAndAlongZHaveCurvesOfTheirOwn) {
  Values values;
  for (const char* name :
       {"a1", "a2", "a3", "a4", "a5", "a6", "a7", "a8", "z1", "z2", "z3", "z4", "z5", "z6", "z7"})
    values.push_back({0, name, 0});
  values[7].value = std::log(0.5);
  values[13].value = std::log(0.8);
  values.push_back({0, "sa", 0.25});
  values.push_back({0, "sz", 0.4});
  const auto f = forces_after(
      learned_axes_effect(), test::press_along({{-1.5e-3, 2e-3, -1.6e-3}, {0, 0, 1.6e-3}}), values);
  EXPECT_NEAR((f[0] - Vec3(0.15, -0.2, 0.8 * 0.32)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[1] - Vec3(0, 0, -0.8 * 0.32)).norm(), 0, 1e-12);
}

// 0.05 s behind a ramp and a hold; the low pass's memory fades within a sample.
TEST(SensorLag, MayBeADelay) {
  PressView press = test::press_to({0, 1e-3, 2e-3, 2e-3, 2e-3});
  press.t = {0, 0.1, 0.2, 0.3, 0.4};
  const auto f = forces_after(sensor_lag_effect(), press, {{0, "tau", 1e-9}, {0, "delay", 0.125}});
  const double depths[] = {0, 0, 0.75e-3, 1.75e-3, 2e-3};
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR(f[i].z(), test::kStiffness * depths[i], 1e-6) << i;
}

TEST(Deadband, IsBlindBelowAndTrueOrShortAbove) {
  const PressView press = test::press_to({0.1e-3, 0.39e-3, 0.61e-3, 2e-3, -2e-3});
  const auto truth = forces_after(deadband_effect(), press, {{0, "d", 0.1}, {0, "k", 0}});
  const auto from_threshold = forces_after(deadband_effect(), press, {{0, "d", 0.1}, {0, "k", 1}});
  const double depths[] = {0, 0, 0.61e-3, 2e-3, -2e-3};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double f = test::kStiffness * depths[i];
    EXPECT_NEAR(truth[i].z(), f, 1e-12) << i;
    EXPECT_NEAR(from_threshold[i].z(), f - (f > 0 ? 0.1 : f < 0 ? -0.1 : 0), 1e-12) << i;
  }
}

TEST(Clipping, EndsEachAxisBothWays) {
  const auto f =
      forces_after(clipping_effect(), test::press_along({{-2e-3, 5e-3, -1e-3}, {1e-3, 1e-3, 4e-3}}),
                   {{0, "Lx", 0.3}, {0, "Ly", 0.5}, {0, "Lz", 0.4}});
  EXPECT_EQ(f[0], Vec3(0.3, -0.5, 0.2));
  EXPECT_EQ(f[1], Vec3(-0.2, -0.2, -0.4));
}

// Ends that the readings show: along x and z exactly, along y nowhere.
TEST(Clipping, StartsWhereReadingsEnd) {
  DataSummary data;
  data.ceiling = {0.25, 0, 0.7};
  EXPECT_EQ(clipping_effect().starts(data, 1),
            (std::vector<std::vector<double>>{{0.25, 1e6, 0.7}}));
  const auto limits = clipping_effect().limits(data);
  EXPECT_NEAR(limits[0].first, 0.2375, 1e-12);
  EXPECT_NEAR(limits[2].second, 0.735, 1e-12);
  EXPECT_EQ(limits[1].second, 1e6);
}

// In to 0.4 N, back to half of it and to nothing: 10 % too little while the force grows, turned
// within a quarter of the largest force, then 10 % too much.
TEST(SensorHysteresis, ReadsTooMuchOnTheWayBack) {
  const auto f =
      forces_after(sensor_hysteresis_effect(), test::press_to({0, 1e-3, 2e-3, 1.8e-3, 1e-3, 0}),
                   {{0, "h", 0.1}, {0, "r", 0.25}});
  const double expected[] = {0, 0.2 * 0.9, 0.4 * 0.9, 0.36 * (1 - 0.1 * 0.6), 0.2 * 1.1, 0};
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(f[i].z(), expected[i], 1e-12) << i;
}

// An inner loop begins to turn where it is; a force the other way reads too little in size as well.
TEST(SensorHysteresis, TurnsBackAndIsTheSameForPulling) {
  const Values values{{0, "h", 0.1}, {0, "r", 0.25}};
  const auto f =
      forces_after(sensor_hysteresis_effect(), test::press_to({0, 2e-3, 1.8e-3, 1.9e-3}), values);
  EXPECT_NEAR(f[3].z(), 0.38 * (1 - 0.1 * 0.8), 1e-12);
  const auto pulled = forces_after(sensor_hysteresis_effect(),
                                   test::press_to({0, -2e-3, -1.8e-3, -1.9e-3}), values);
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR((f[i] + pulled[i]).norm(), 0, 1e-12) << i;
}

// A ramp and a hold, 0.125 s early.
TEST(Clock, HasTheForceOfLater) {
  PressView press = test::press_to({0, 1e-3, 2e-3, 2e-3, 2e-3});
  press.t = {0, 0.1, 0.2, 0.3, 0.4};
  press.session = press.t;
  const auto f = forces_after(clock_effect(), press, {{0, "e0", 0.125}, {0, "r", 0}});
  const double depths[] = {1.25e-3, 2e-3, 2e-3, 2e-3, 2e-3};
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR(f[i].z(), test::kStiffness * depths[i], 1e-12) << i;
}

// By the time of the session: 0.05 s early after 500 s, 0.05 s late with the opposite rate.
TEST(Clock, RunsFastOrSlow) {
  PressView press = test::press_to({0, 1e-3, 2e-3});
  press.t = {0, 0.1, 0.2};
  press.session = {500, 500.1, 500.2};
  const auto fast = forces_after(clock_effect(), press, {{0, "e0", 0}, {0, "r", 1e-4}});
  EXPECT_NEAR(fast[1].z(), 0.2 + 0.2 * 0.5001, 1e-12);
  EXPECT_NEAR(fast[2].z(), 0.4, 1e-12);
  const auto slow = forces_after(clock_effect(), press, {{0, "e0", 0}, {0, "r", -1e-4}});
  EXPECT_NEAR(slow[1].z(), 0.2 - 0.2 * 0.5001, 1e-12);
  EXPECT_NEAR(slow[0].z(), 0, 1e-12);
}

// The step response of two equal poles, 1 - (1 + w t) exp(-w t), after a step within 1 us.
TEST(Filter, AnswersAStepAsItsEquationDoes) {
  PressView press = test::press_to({0, 2e-3, 2e-3, 2e-3, 2e-3});
  press.t = {0, 1e-6, 0.02, 0.07, 0.2};
  const double w = 2 * M_PI * 3;
  const auto equal = forces_after(filter_effect(), press, {{0, "f0", 3}, {0, "zeta", 1}});
  const double zeta = 0.5, wd = w * std::sqrt(1 - zeta * zeta);
  const auto swinging = forces_after(filter_effect(), press, {{0, "f0", 3}, {0, "zeta", zeta}});
  for (std::size_t i = 2; i < press.t.size(); ++i) {
    const double t = press.t[i];
    EXPECT_NEAR(equal[i].z(), 0.4 * (1 - (1 + w * t) * std::exp(-w * t)), 1e-5) << i;
    EXPECT_NEAR(
        swinging[i].z(),
        0.4 * (1 - std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t))),
        1e-5)
        << i;
  }
}

// Long after a ramp began the reading is late by 2 zeta / w.
TEST(Filter, IsLateByItsTime) {
  std::vector<double> depths;
  PressView press;
  for (int i = 0; i <= 100; ++i) depths.push_back(1e-5 * i);
  press = test::press_to(depths);
  for (int i = 0; i <= 100; ++i) press.t.push_back(0.01 * i);
  const auto f = forces_after(filter_effect(), press, {{0, "f0", 5}, {0, "zeta", 0.7}});
  const double late = 2 * 0.7 / (2 * M_PI * 5);
  EXPECT_NEAR(f[100].z(), test::kStiffness * 1e-3 * (1 - late), 1e-9);
}

TEST(SensorSettling, GoesToItsValueAndStays) {
  PressView press = test::press_to({0, 0, 0});
  press.session = {0, 100 * std::log(2.0), 1e5};
  const auto f = forces_after(sensor_settling_effect(), press,
                              {{0, "bx", 0.1},
                               {0, "by", 0},
                               {0, "bz", -0.2},
                               {0, "cx", 0},
                               {0, "cy", 0.4},
                               {0, "cz", 1},
                               {0, "tau", 100}});
  EXPECT_NEAR((f[0] - Vec3(0.1, 0, -0.2)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[1] - Vec3(0.1, 0.2, 0.3)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[2] - Vec3(0.1, 0.4, 0.8)).norm(), 0, 1e-12);
}

// A quarter and three quarters of a period of 4 s after the session began, pressed or not.
TEST(SensorHum, SwingsInTheAirToo) {
  PressView press = test::press_to({1e-3, 1e-3, 0});
  press.session = {1, 3, 4};
  press.in_air[2] = 1;
  const auto f = forces_after(sensor_hum_effect(), press,
                              {{0, "sx", 0.1},
                               {0, "sy", 0},
                               {0, "sz", 0.2},
                               {0, "cx", 0},
                               {0, "cy", 0.3},
                               {0, "cz", 0},
                               {0, "f", 0.25}});
  const Vec3 pressed(0, 0, test::kStiffness * 1e-3);
  EXPECT_NEAR((f[0] - pressed - Vec3(0.1, 0, 0.2)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[1] - pressed + Vec3(0.1, 0, 0.2)).norm(), 0, 1e-12);
  EXPECT_NEAR((f[2] - Vec3(0, 0.3, 0)).norm(), 0, 1e-12);
}

TEST(Tare, IsTheOffsetOfItsOwnPress) {
  PressView press = test::press_along(kPath);
  const Values values{{0, "bx1", 1}, {0, "by1", 2}, {0, "bz1", 3},
                      {0, "bx2", 4}, {0, "by2", 5}, {0, "bz2", 6}};
  press.number = 2;
  const auto f = forces_after(tare_effect(), press, values);
  EXPECT_NEAR((f[1] - Vec3(4.4, 5, 6)).norm(), 0, 1e-12);
  press.number = 3;  // of another recording
  EXPECT_NEAR((forces_after(tare_effect(), press, values)[1] - Vec3(0.4, 0, 0)).norm(), 0, 1e-12);
}

// A tool that is accelerated evenly, in steps that are not even; the first sample and the last know
// nothing.
TEST(ToolInertia, IsMassTimesAcceleration) {
  const std::vector<double> t{0, 0.01, 0.03, 0.04, 0.07};
  std::vector<double> depths;
  for (const double x : t) depths.push_back(0.5 * 2 * x * x);  // 2 m/s^2 along -z
  PressView press = test::press_to(depths);
  press.t = t;
  const auto f = forces_after(tool_inertia_effect(), press, {{0, "m", 0.3}});
  for (std::size_t i = 0; i < t.size(); ++i)
    EXPECT_NEAR(f[i].z(),
                test::kStiffness * depths[i] + (i == 0 || i + 1 == t.size() ? 0 : 0.3 * 2), 1e-12)
        << i;
}

}  // namespace
}  // namespace hapsim
