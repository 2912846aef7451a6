// Laws of relaxation that are sums of exponentials, against their closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/effects.h"
#include "effects/maxwell_spectrum.h"
#include "one_press.h"

namespace hapsim {
namespace {

double kernel(const MaxwellSpectrum& s, double x) {
  double sum = 0;
  for (std::size_t i = 0; i < MaxwellSpectrum::kSize; ++i)
    sum += s.weight[i] * std::exp(-s.rate[i] * x);
  return sum;
}

TEST(MaxwellSpectrum, IsThePowerLaw) {
  for (const double a : {0.02, 0.1, 0.3, 0.7, 1.0}) {
    const MaxwellSpectrum s = power_law_spectrum(a);
    for (double x = 1e-3; x < 1e5; x *= 1.7)
      EXPECT_NEAR(kernel(s, x), std::pow(1 + x, -a), 1e-3) << a << " at " << x;
  }
}

TEST(MaxwellSpectrum, IsTheExponentialOfTheRoot) {
  for (double x = 1e-2; x < 25; x *= 1.5)
    EXPECT_NEAR(kernel(square_root_spectrum(), x), std::exp(-std::sqrt(x)), 2e-3) << x;
}

// A way in at once, held: the force is the kernel itself.
std::vector<Vec3> held(const Effect& effect, const Values& values, const std::vector<double>& t,
                       double depth, double radius) {
  PressView press = test::press_to(std::vector<double>(t.size(), depth));
  press.t = t;
  press.radius = radius;
  return test::forces_after(effect, press, values);
}

TEST(Fractional, RelaxesByAPowerOfTime) {
  const std::vector<double> t{0, 0.01, 0.1, 1, 10, 1000};
  const double E = 1e4, Ef = 6e3, alpha = 0.3, tau0 = 0.02, depth = 2e-3;
  const auto f = held(fractional_effect(), {{0, "Ef", Ef}, {0, "alpha", alpha}, {0, "tau0", tau0}},
                      t, depth, 0.004);
  for (std::size_t i = 0; i < t.size(); ++i)
    EXPECT_NEAR(f[i].z(),
                test::kStiffness * depth * (1 + Ef / E * std::pow(1 + t[i] / tau0, -alpha)), 1e-4)
        << t[i];
}

// The drained force at the end, 2 (1 - nu_d) times as much at the beginning, and the same course in
// D t / a^2 under any tool.
TEST(Poroelastic, FollowsTheTimeOverTheRadiusSquared) {
  const double D = 2e-6, drained = 0.2, depth = 2e-3;
  const Values values{{0, "nu_d", drained}, {0, "D", D}};
  for (const double a : {0.002, 0.006}) {
    const double unit = a * a / D;
    const auto f =
        held(poroelastic_effect(), values, {0, 0.3 * unit, 2 * unit, 1e4 * unit}, depth, a);
    const auto expected = [&](double x) {
      return test::kStiffness * depth *
             (1 +
              (1 - 2 * drained) * (1.304 * std::exp(-std::sqrt(x)) - 0.304 * std::exp(-0.254 * x)));
    };
    EXPECT_NEAR(f[0].z(), 2 * (1 - drained) * test::kStiffness * depth, 1e-9);
    EXPECT_NEAR(f[1].z(), expected(0.3), 1e-3);
    EXPECT_NEAR(f[2].z(), expected(2), 1e-3);
    EXPECT_NEAR(f[3].z(), test::kStiffness * depth, 1e-3);
  }
}

TEST(Qlv, RelaxesByAnotherShareAtAnotherDepth) {
  const double E = 1e4, Eq = 5e3, tau = 0.5, m = 0.7, a = 0.004;
  for (const double depth : {1e-3, 4e-3}) {
    const auto f =
        held(qlv_effect(), {{0, "Eq", Eq}, {0, "tau", tau}, {0, "m", m}}, {0, 0.4}, depth, a);
    const double share = Eq / E * std::pow(depth / a, m);
    EXPECT_NEAR(f[0].z(), test::kStiffness * depth * (1 + share), 1e-12);
    EXPECT_NEAR(f[1].z(), test::kStiffness * depth * (1 + share * std::exp(-0.4 / tau)), 1e-12);
  }
}

}  // namespace
}  // namespace hapsim
