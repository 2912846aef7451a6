// Effects between the tool and the body against their closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "one_press.h"

namespace hapsim {
namespace {

using test::forces_after;
using test::kStiffness;

TEST(Backlash, LagsByTheGapAfterAReversalAndNotBefore) {
  const PressView press =
      test::press_to({0, 1e-3, 2e-3, 1.9e-3, 1.7e-3, 1e-3, 1.05e-3, 2e-3, 3e-3});
  const auto f = forces_after(backlash_effect(), press, {{0, "g", 2e-4}});
  // Taken up on the way in; 0.2 mm deeper on the way out; half-way inside the gap it rests.
  const double depth[] = {0, 1e-3, 2e-3, 2e-3, 1.9e-3, 1.2e-3, 1.2e-3, 2e-3, 3e-3};
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR(f[i].z(), kStiffness * depth[i], 1e-12) << i;
}

TEST(Backlash, ActsAlongTheDirectionOfThePress) {
  PressView press = test::press_along({{0, 0, 0}, {1e-3, 0, -1e-3}, {0.5e-3, 0, -0.5e-3}});
  press.direction = Vec3(1, 0, -1).normalized();
  const auto f = forces_after(backlash_effect(), press, {{0, "g", std::sqrt(2.0) * 1e-4}});
  EXPECT_NEAR((f[2] - kStiffness * Vec3(-0.6e-3, 0, 0.6e-3)).norm(), 0, 1e-12);
}

TEST(Slack, NeverPulls) {
  const auto f =
      forces_after(slack_effect(), test::press_to({-1e-3, 0, 1e-3, -2e-3}), {{0, "enabled", 1}});
  EXPECT_EQ(f[0], Vec3(0, 0, 0));
  EXPECT_NEAR(f[2].z(), kStiffness * 1e-3, 1e-12);
  EXPECT_EQ(f[3], Vec3(0, 0, 0));
}

TEST(Adhesion, PullsOnTheWayOutUntilItComesOff) {
  const double F = 0.05, d = 1e-4, a = 0.2;
  const PressView press =
      test::press_to({-2e-4, 0, 1e-3, 2e-3, 1.95e-3, 1e-3, 1e-4, -0.5e-4, -1e-4, -0.5e-4, 1e-4});
  const auto f = forces_after(adhesion_effect(), press, {{0, "F", F}, {0, "d", d}, {0, "a", a}});
  const double hold[] = {0, 0, a, a, a + (1 - a) * 0.5, 1, 1, 0.5, /* off */ 0, 0, a};
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR(f[i].z(), -kStiffness * press.u[i].z() - F * hold[i], 1e-12) << i;
}

TEST(Friction, SticksSlidesAndKeepsItsSet) {
  const double mu = 0.5, n = 2e-3;  // normal depth: the bound is 0.2 N, reached at 1 mm
  const PressView press = test::press_along({{0, 0, -n},
                                             {0.5e-3, 0, -n},
                                             {2e-3, 0, -n},
                                             {3e-3, 0, -n},
                                             {2.5e-3, 0, -n},
                                             {1e-3, 0, -n},
                                             {0, 0, -n},
                                             {0, 0, -n}});
  const auto f = forces_after(friction_effect(), press, {{0, "mu", mu}});
  const double bound = mu * kStiffness * n;
  const double tangential[] = {0,     -0.1,  -bound, -bound, -bound + kStiffness * 0.5e-3,
                               bound, bound, bound};
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_NEAR(f[i].x(), tangential[i], 1e-12) << i;
    EXPECT_NEAR(f[i].z(), kStiffness * n, 1e-12) << i;
  }
}

TEST(Friction, ForgetsItsSetInTheAir) {
  PressView press = test::press_along(
      {{0, 0, -1e-3}, {2e-3, 0, -1e-3}, {2e-3, 0, 1e-3}, {0, 0, 1e-3}, {0, 0, -1e-3}});
  press.in_air = {0, 0, 1, 1, 0};
  const auto f = forces_after(friction_effect(), press, {{0, "mu", 0.3}});
  EXPECT_NEAR(f[1].x(), -0.3 * kStiffness * 1e-3, 1e-12);
  EXPECT_NEAR(f[4].x(), 0, 1e-12);
}

}  // namespace
}  // namespace hapsim
