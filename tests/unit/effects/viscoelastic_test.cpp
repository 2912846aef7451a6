// Relaxation against its closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kSpring = 200;  // [N/m]
constexpr double kModulus = 1e4, kE1 = 6e3, kTau1 = 0.3, kE2 = 2e3, kTau2 = 5;

Eigen::VectorXd relax(PressView press) {
  press.modulus = kModulus;
  press.in_air.assign(press.size(), 0);
  Signal signal;
  signal.f.resize(3 * static_cast<Eigen::Index>(press.size()));
  for (std::size_t i = 0; i < press.size(); ++i)
    signal.f.segment<3>(3 * static_cast<Eigen::Index>(i)) = -kSpring * press.u[i];
  signal.df.resize(signal.f.size(), 0);
  viscoelastic_effect().apply(
      press, {{0, "E1", kE1}, {0, "tau1", kTau1}, {0, "E2", kE2}, {0, "tau2", kTau2}}, signal);
  return signal.f;
}

// Ramp of rate v until t1, then hold: the convolution of the relaxation function with a ramp,
// f(t) = k v [t + sum g tau (1 - exp(-t/tau))], minus the same ramp begun at t1.
double ramp_and_hold(double t, double v, double t1) {
  const auto ramp = [&](double s) {
    if (s <= 0) return 0.0;
    double f = s;
    f += kE1 / kModulus * kTau1 * (1 - std::exp(-s / kTau1));
    f += kE2 / kModulus * kTau2 * (1 - std::exp(-s / kTau2));
    return kSpring * v * f;
  };
  return ramp(t) - ramp(t - t1);
}

TEST(Viscoelastic, RampAndHoldIsExactForAnySteps) {
  const double v = 0.01, t1 = 0.25;
  for (const double step : {0.001, 0.05, 0.25}) {
    PressView press;
    double t = 0;
    int i = 0;
    while (t < 8) {
      press.t.push_back(t);
      press.u.push_back({0, 0, -v * std::min(t, t1)});
      // Steps that change, but meet the corner at t1.
      t += t < t1 - 1e-9 ? step : (i++ % 3 == 0 ? 0.4 : 0.01);
    }
    const Eigen::VectorXd f = relax(press);
    double worst = 0;
    for (std::size_t k = 0; k < press.size(); ++k)
      worst = std::max(worst, std::abs(f[3 * static_cast<Eigen::Index>(k) + 2] -
                                       ramp_and_hold(press.t[k], v, t1)));
    std::printf("steps of %.3f s: worst error %.2g N\n", step, worst);
    EXPECT_LT(worst, 1e-8);
  }
}

TEST(Viscoelastic, AStepJumpsAndRelaxes) {
  PressView press;
  press.t = {0, 1, 100};
  press.u.assign(3, Vec3(0, 0, -0.001));
  const Eigen::VectorXd f = relax(press);
  EXPECT_NEAR(f[2], 0.2 * (1 + 0.6 + 0.2), 1e-12);
  EXPECT_NEAR(f[5], 0.2 * (1 + 0.6 * std::exp(-1 / kTau1) + 0.2 * std::exp(-1 / kTau2)), 1e-12);
  EXPECT_NEAR(f[8], 0.2, 1e-8);
}

}  // namespace
}  // namespace hapsim
