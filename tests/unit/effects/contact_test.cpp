// Effects between the tool and the body against their closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/local_contact.h"
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

// Forces of a body of stiffness press.contact.K after an effect that moves.
std::vector<Vec3> forces_on(const PressView& press, const Effect& effect, const Values& values) {
  Motion motion{press.u, {}, 0};
  effect.move(press, values, motion);
  std::vector<Vec3> f;
  for (const Vec3& u : motion.u) f.push_back(-press.contact.K * u);
  return f;
}

// A half-space that is softer by `far` [m/N] in every direction.
PressView on_half_space(const std::vector<Vec3>& path, double nu, double far = 0) {
  PressView press = test::press_along(path);
  press.contact.nu = nu;
  const DiscStiffness disc = bonded_disc(press.contact.modulus, nu, press.radius);
  press.contact.K = Vec3(1 / (1 / disc.tangential + far), 1 / (1 / disc.tangential + far),
                         1 / (1 / disc.normal + far))
                        .asDiagonal();
  return press;
}

// Hertz (Johnson, Contact Mechanics, 4.22): F = 4/3 E/(1 - nu^2) sqrt(R) z^(3/2). Without friction;
// for nu = 1/2 bonding makes no difference. Beyond the cap the tool is flat.
TEST(Tip, IsHertzOnAHalfSpaceAndThenFlat) {
  const double nu = 0.4999, R = 0.02, full = 0.004 * 0.004 / R;  // 0.8 mm
  const std::vector<double> depths{0.1e-3, 0.4e-3, 0.79e-3, 2e-3, 0.4e-3, -1e-3, 0.4e-3};
  std::vector<Vec3> path;
  for (const double z : depths) path.emplace_back(0, 0, -z);
  const PressView press = on_half_space(path, nu);
  const auto f = forces_on(press, tip_effect(), {{0, "kappa", 1 / R}});
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double z = std::max(0.0, depths[i]);
    const double hertz = 4.0 / 3 * press.contact.modulus / (1 - nu * nu) * std::sqrt(R * z * z * z);
    const double flat = press.contact.K(2, 2) * (z - full / 3);
    EXPECT_NEAR(f[i].z(), z < full ? hertz : flat, 2e-4 * std::abs(flat)) << i;
    EXPECT_NEAR(f[i].head<2>().norm(), 0, 1e-12) << i;
  }
}

// dF = du / (1/k(c) + C), c that of the depth less what the far field gives way.
TEST(Tip, StandsInSeriesWithTheRestOfTheBody) {
  const double far = 2e-3, kappa = 100, depth = 3e-3;
  const PressView press = on_half_space({{0, 0, -depth}}, 0.4, far);
  const double k_n = bonded_disc(press.contact.modulus, 0.4, press.radius).normal;
  double F = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double z = (i + 0.5) * depth / kSteps - far * F;
    const double c = std::min(std::sqrt(std::max(z, 1e-12) / kappa), press.radius);
    F += depth / kSteps / (1 / (k_n * c / press.radius) + far);
  }
  EXPECT_NEAR(forces_on(press, tip_effect(), {{0, "kappa", kappa}})[0].z(), F, 1e-4 * F);
}

TEST(Tip, HoldsSidewaysWhatTouchesAndLetsGoOfWhatParts) {
  const double kappa = 200, full = kappa * 0.004 * 0.004;  // 3.2 mm
  const double x = 0.5e-3;
  const PressView press = on_half_space({{0, 0, -full / 2},
                                         {x, 0, -full / 2},
                                         {x, 0, -full / 8},
                                         {x, 0, -full / 2},
                                         {x, 0, 0},
                                         {x, 0, -full / 2}},
                                        0.4);
  const auto f = forces_on(press, tip_effect(), {{0, "kappa", kappa}});
  const double k_t = press.contact.K(0, 0);
  EXPECT_NEAR(f[0].x(), 0, 1e-12);
  EXPECT_NEAR(f[1].x(), -k_t * std::sqrt(0.5) * x, 1e-9);
  EXPECT_NEAR(f[2].x(), -k_t * std::sqrt(0.125) * x, 1e-9);  // the outer rings have let go
  EXPECT_NEAR(f[3].x(), f[2].x(), 1e-9);                     // and touch again without strain
  EXPECT_NEAR(f[5].x(), 0, 1e-12);
}

TEST(Tip, AnObliqueWayInIsTheWayOut) {
  const Vec3 deepest(1e-3, -0.5e-3, -2e-3);
  std::vector<Vec3> path;
  for (int i = 0; i <= 20; ++i) path.push_back((10 - std::abs(i - 10)) / 10.0 * deepest);
  PressView press = on_half_space(path, 0.4, 1e-3);
  press.contact.K(0, 2) = press.contact.K(2, 0) = 10;
  const auto f = forces_on(press, tip_effect(), {{0, "kappa", 100}});
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR((f[i] - f[20 - i]).norm(), 0, 1e-5 * f[10].norm()) << i;
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

// A press that is recorded too shallow by d is pressed d deeper; one that is recorded too deep is
// free until it has gone that far.
TEST(Touch, MovesTheFirstContact) {
  const PressView press = test::press_to({0, 1e-4, 1e-3});
  const std::vector<Vec3> late = test::forces_after(touch_effect(), press, {{0, "d", 2e-4}});
  EXPECT_NEAR(late[1].z(), test::kStiffness * 3e-4, 1e-12);
  EXPECT_NEAR(late[2].z(), test::kStiffness * 1.2e-3, 1e-12);
  const std::vector<Vec3> early = test::forces_after(touch_effect(), press, {{0, "d", -2e-4}});
  EXPECT_EQ(early[1].norm(), 0);
  EXPECT_NEAR(early[2].z(), test::kStiffness * 8e-4, 1e-12);
}

// In doubt from the start for a declared ball pressed a few times, for nothing else.
TEST(Touch, IsInDoubtUnderABall) {
  DataSummary data;
  EXPECT_FALSE(touch_effect().doubted(data));
  data.ball_radius = 4e-3;
  EXPECT_TRUE(touch_effect().doubted(data));
  data.presses = 40;
  EXPECT_FALSE(touch_effect().doubted(data));
}

// Springs in series: 1/k = 1/200 + c, along each axis.
// Half a period of 2 s after the session began, and in the air not at all.
TEST(Breathing, MovesTheBodyUnderTheTool) {
  PressView press = test::press_to({1e-3, 1e-3, 1e-3, 0});
  press.session = {0, 0.5, 1.5, 0.5};
  press.in_air[3] = 1;
  const Values values{
      {0, "ax", 1e-4}, {0, "ay", 0}, {0, "az", 2e-4}, {0, "f", 0.5}, {0, "phase", 0}};
  const auto f = forces_after(breathing_effect(), press, values);
  const Vec3 still(0, 0, 0.2), moved(0.02, 0, 0.04);
  EXPECT_NEAR((f[0] - still).norm(), 0, 1e-12);
  EXPECT_NEAR((f[1] - still - moved).norm(), 0, 1e-12);  // the body comes up
  EXPECT_NEAR((f[2] - still + moved).norm(), 0, 1e-12);
  EXPECT_EQ(f[3], Vec3::Zero());
}

// What a body of 200 N/m leaves of a wave: where the fit begins.
TEST(Breathing, StartsFromTheLineThatIsLeft) {
  DataSummary data;
  data.peak_stiffness = test::kStiffness;
  const Vec3 a(1e-4, 0, -3e-4);
  data.line = {0.3, 1e-3, std::cos(0.7) * test::kStiffness * a,
               std::sin(0.7) * test::kStiffness * a};
  const std::vector<double> start = breathing_effect().starts(data, 1).front();
  const double sign = start[2] * a.z() > 0 ? 1 : -1;  // the same wave by half a period
  EXPECT_NEAR((sign * Vec3(start[0], start[1], start[2]) - a).norm(), 0, 1e-15);
  EXPECT_EQ(start[3], 0.3);
  EXPECT_NEAR(std::cos(start[4] - 0.7), sign, 1e-12);
}

// In to 4 mm of which a quarter beyond 2 mm stays, out again; the next press begins half a
// millimetre later and loads along the way out until it is as deep as the first.
TEST(Plastic, LoadsAgainAlongItsWayOut) {
  const Values values{{0, "p", 0.25}, {0, "y", 2e-3}};
  PressView press = test::press_to({1e-3, 2e-3, 4e-3, 2e-3, 5e-4, 2e-4});
  auto f = forces_after(plastic_effect(), press, values);
  const std::vector<double> left{1e-3, 2e-3, 3.5e-3, 1.5e-3, 0, 0};
  for (std::size_t i = 0; i < left.size(); ++i)
    EXPECT_NEAR(f[i].z(), test::kStiffness * left[i], 1e-12) << i;
  press.past_depth = 4e-3;
  f = forces_after(plastic_effect(), press, values);
  EXPECT_NEAR(f[0].z(), test::kStiffness * 5e-4, 1e-12);
  EXPECT_NEAR(f[2].z(), test::kStiffness * 3.5e-3, 1e-12);
}

TEST(ArmCompliance, IsASpringInSeries) {
  const auto f = forces_after(arm_compliance_effect(), test::press_along({{1e-3, 2e-3, -3e-3}}),
                              {{0, "cx", 0.005}, {0, "cy", 0}, {0, "cz", 0.015}});
  EXPECT_NEAR((f[0] - Vec3(-0.1, -0.4, 0.15)).norm(), 0, 1e-12);
}

// u = u_recorded + C f balances f = -K u of a stiffness that couples the axes.
TEST(ArmCompliance, BalancesACoupledBody) {
  PressView press = test::press_along({{1e-3, -2e-3, -3e-3}});
  press.contact.K << 150, 10, -20, 10, 120, 30, -20, 30, 300;
  const Values values{{0, "cx", 0.001}, {0, "cy", 0.004}, {0, "cz", 0.002}};
  Signal signal{-press.contact.K * press.u[0], {}};
  signal.df.resize(3, 0);
  arm_compliance_effect().apply(press, values, signal);
  const Vec3 u = press.u[0] + Vec3(0.001, 0.004, 0.002).cwiseProduct(Vec3(signal.f));
  EXPECT_NEAR((Vec3(signal.f) + press.contact.K * u).norm(), 0, 1e-12);
}

// A body held at once at 1 mm, its force then half as large again and relaxing, and the arm's way
// back: of springs and a dashpot in series the first force is K (1 + e) / (1 + K (1 + e) C) u,
// which comes out too large by what the card says.
TEST(ArmCompliance, ErrsWithWhatRelaxesAsItsCardSays) {
  constexpr double e = 0.5, K = test::kStiffness, C = 0.1 / K, u = 1e-3;
  Signal signal{Vec3(0, 0, (1 + e) * K * u), Eigen::MatrixXd(3, 0)};
  arm_compliance_effect().apply(test::press_to({u}), {{0, "cx", C}, {0, "cy", C}, {0, "cz", C}},
                                signal);
  const double exact = K * (1 + e) / (1 + K * (1 + e) * C) * u;
  EXPECT_NEAR(signal.f[2] / exact - 1, e * K * C / (1 + K * C), 1e-12);
}

// Flat punch on a half-space: the force goes as the radius, along the normal and across it.
TEST(ToolRadius, ScalesTheForceOnAHalfSpace) {
  PressView press = test::press_along({{1e-3, 2e-3, -3e-3}});
  press.contact.modulus = 2e4;
  press.contact.nu = 0.4;
  const DiscStiffness disc = bonded_disc(press.contact.modulus, press.contact.nu, press.radius);
  press.contact.K = Vec3(disc.tangential, disc.tangential, disc.normal).asDiagonal();
  for (const double s : {0.5, 2.0}) {
    const Vec3 f = -press.contact.K * press.u[0];
    Signal signal{f, Eigen::MatrixXd(3, 0)};
    tool_radius_effect().apply(press, {{0, "s", s}}, signal);
    EXPECT_NEAR((Vec3(signal.f) - s * f).norm(), 0, 1e-12 * f.norm());
  }
}

TEST(MotionRotation, AQuarterTurnExchangesAxes) {
  const auto f = forces_after(motion_rotation_effect(), test::press_along({{0, 2e-3, -1e-3}}),
                              {{0, "rx", 0}, {0, "ry", M_PI / 2}, {0, "rz", 0}});
  EXPECT_NEAR((f[0] - Vec3(0.2, -0.4, 0)).norm(), 0, 1e-12);  // -z becomes -x
}

TEST(MotionScale, StretchesTwoAxes) {
  const auto f = forces_after(motion_scale_effect(), test::press_along({{1e-3, 2e-3, -3e-3}}),
                              {{0, "sx", 1.5}, {0, "sy", 0.5}});
  EXPECT_NEAR((f[0] - Vec3(-0.3, -0.2, 0.6)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace hapsim
