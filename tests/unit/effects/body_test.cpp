// Temperature, softening and damping against their closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/catalogue.h"
#include "one_press.h"

namespace hapsim {
namespace {

using test::forces_after;
using test::kStiffness;

TEST(Temperature, HalvesTheStiffnessOverItsHalvingRange) {
  PressView press = test::press_to({1e-3, 1e-3, 1e-3});
  press.temperature = {20, 30, 10};
  const auto f = forces_after(temperature_effect(), press,
                              {{0, "beta", std::log(2.0) / 10}, {0, "T_ref", 20}});
  EXPECT_NEAR(f[0].z(), 0.2, 1e-12);
  EXPECT_NEAR(f[1].z(), 0.1, 1e-12);
  EXPECT_NEAR(f[2].z(), 0.4, 1e-12);
}

// Of a body that couples all directions, along a closed way through large depths.
TEST(Hyperelastic, AClosedWayDoesNoWork) {
  std::vector<Vec3> path;
  constexpr int kSteps = 4000;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 2 * M_PI * i / kSteps;
    path.push_back(1e-3 * Vec3(2 * std::sin(angle), std::sin(2 * angle), -4 + 3 * std::cos(angle)));
  }
  PressView press = test::press_along(path);
  press.contact.K << 50, 3, 8, 3, 60, -5, 8, -5, 90;
  Signal signal{Eigen::VectorXd(3 * (kSteps + 1)), Eigen::MatrixXd(3 * (kSteps + 1), 0)};
  for (int i = 0; i <= kSteps; ++i) signal.f.segment<3>(3 * i) = -press.contact.K * path[i];
  const Eigen::VectorXd linear = signal.f;
  hyperelastic_effect().apply(press, {{0, "s", 0.4}, {0, "finite", 1}}, signal);
  double work = 0, size = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 mean = (signal.f.segment<3>(3 * i) + signal.f.segment<3>(3 * i + 3)) / 2;
    work += mean.dot(path[i + 1] - path[i]);
    size += std::abs(mean.dot(path[i + 1] - path[i]));
  }
  EXPECT_NEAR(work, 0, 1e-5 * size);
  EXPECT_GT((signal.f - linear).norm(), 0.2 * linear.norm());
}

TEST(Hyperelastic, SmallPressesAreLinear) {
  const auto f = forces_after(hyperelastic_effect(), test::press_along({{1e-6, 0, -2e-6}}),
                              {{0, "s", 0.3}, {0, "finite", 1}});
  EXPECT_NEAR((f[0] - kStiffness * Vec3(-1e-6, 0, 2e-6)).norm(), 0, 1e-3 * f[0].norm());
}

TEST(Softening, OnlyBelowTheDeepestPressSoFar) {
  PressView press = test::press_to({1e-3, 2e-3, 1e-3, 2e-3, 3e-3});
  const Values values{{0, "s", 0.3}, {0, "m", 2}, {0, "c", 1}, {0, "k", 2}, {0, "rate", 0}};
  const auto first = forces_after(softening_effect(), press, values);
  const double fresh[] = {0.2, 0.4, 0.2 * (1 - 0.3 * 0.75), 0.4, 0.6};
  press.past_depth = 4e-3;
  const auto again = forces_after(softening_effect(), press, values);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double x = press.u[i].norm() / 4e-3;
    EXPECT_NEAR(first[i].z(), fresh[i], 1e-12) << i;
    EXPECT_NEAR(again[i].z(), kStiffness * press.u[i].norm() * (1 - 0.3 * (1 - x * x)), 1e-12) << i;
  }
}

// Beyond the earlier depth the loss fades like its square, not at all, or at once.
TEST(Softening, MayTouchLaterPressesAlone) {
  PressView press = test::press_to({1e-3, 2e-3, 1e-3, 3e-3});
  const auto values = [](double k) {
    return Values{{0, "s", 0.3}, {0, "m", 2}, {0, "c", 0}, {0, "k", k}, {0, "rate", 0}};
  };
  const auto first = forces_after(softening_effect(), press, values(2));
  press.past_depth = 2e-3;
  const std::pair<double, double> beyond[] = {{2, 1 - 0.3 * 4 / 9}, {0, 0.7}, {50, 1}};
  for (const auto& [k, factor] : beyond) {
    const auto again = forces_after(softening_effect(), press, values(k));
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double f = kStiffness * press.u[i].norm();
      EXPECT_NEAR(first[i].z(), f, 1e-12) << i;
      EXPECT_NEAR(again[i].z(), f * (i < 3 ? 0.7 : factor), 1e-9) << i << " " << k;
    }
  }
}

// A spring of k and a dashpot of its own viscosity, and one at the tool, at a steady speed.
TEST(Damper, OfTheBodyAndOfTheTool) {
  PressView press = test::press_to({0, 1e-3, 2e-3, 2e-3});
  press.t = {0, 0.1, 0.2, 0.3};
  const Values values{{0, "c", 3}, {0, "tau", 0.05}};
  const auto f = forces_after(damper_effect(), press, values);
  const double moving = kStiffness * 0.05 * 1e-2 + 3 * 1e-2;
  EXPECT_NEAR(f[1].z(), kStiffness * 1e-3 + moving, 1e-12);
  EXPECT_NEAR(f[2].z(), kStiffness * 2e-3 + moving, 1e-12);
  EXPECT_NEAR(f[3].z(), kStiffness * 2e-3, 1e-12);
}

TEST(Softening, MayComeWithTimeAlone) {
  PressView press = test::press_to({1e-3, 2e-3, 1e-3});
  press.session = {100, 101, 102};
  const Values values{{0, "s", 0}, {0, "m", 2}, {0, "c", 1}, {0, "k", 2}, {0, "rate", 2e-3}};
  const auto aged = forces_after(softening_effect(), press, values);
  for (std::size_t i = 0; i < aged.size(); ++i)
    EXPECT_NEAR(aged[i].z(), kStiffness * press.u[i].norm() * std::exp(-0.2), 1e-12) << i;
}

// What data can tell bounds a fit: times from a sample's step on, balls within the body.
TEST(Limits, AreTheDatas) {
  DataSummary data;
  data.sample_step = 0.05;
  data.low = Vec3(-0.04, -0.03, 0);
  data.high = Vec3(0.04, 0.03, 0.02);
  EXPECT_EQ(viscoelastic_effect().limits(data)[1].first, 0.05);
  const auto ball = inclusion_effect().limits(data);
  EXPECT_EQ(ball[2], std::pair(0.0, 0.02));
  EXPECT_EQ(ball[3].second, 0.01);
  for (const Effect* effect : catalogue()) {
    const auto limits = effect->limits({});
    ASSERT_EQ(limits.size(), effect->card().parameters.size());
    for (std::size_t k = 0; k < limits.size(); ++k) {
      EXPECT_GE(limits[k].first, effect->card().parameters[k].lower) << effect->card().name;
      EXPECT_LE(limits[k].second, effect->card().parameters[k].upper) << effect->card().name;
    }
  }
}

}  // namespace
}  // namespace hapsim
