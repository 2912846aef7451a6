// What the allowance for a ball's law holds, against a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/weights.h"

namespace hapsim {
namespace {

constexpr double kNoise = 1e-4;  // [N]

// A bonded layer under a ball to second order in chi = sqrt(R depth) / thickness (Dimitriadis et
// al., Biophys. J. 82, 2002, eq. 13), nu = 0.45; `stiffer`: of the first-order term.
double layer(double depth, double stiffer) {
  const double chi = 0.5 * std::sqrt(depth / 1e-3), pi = 3.14159265358979;
  const double alpha = -(1.2876 - 1.4678 * 0.45 + 1.3442 * 0.45 * 0.45) / (1 - 0.45);
  return std::pow(depth / 1e-3, 1.5) *
         (1 - (1 + stiffer) * 2 * alpha / pi * chi + 4 * alpha * alpha / (pi * pi) * chi * chi);
}

Dataset one_press(int samples) {
  Dataset d;
  d.positions = {Vec3::Zero()};
  d.setups = {{0, 0.004}};
  d.setup_of = {0};
  Episode e;
  for (int i = 0; i < samples; ++i) e.rows.push_back(i);
  d.episodes = {e};
  return d;
}

double left(const Dataset& d, const Eigen::VectorXd& f, Eigen::VectorXd difference) {
  Weights(d, {0}, f, kNoise, 0.01).whiten(difference);
  return difference.norm() / std::sqrt(static_cast<double>(difference.size()));
}

TEST(Weights, ABallsBodyMayBendTheForceOverDepth) {
  constexpr int kSamples = 60;
  Dataset d = one_press(kSamples);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * kSamples), other = f, wave = f;
  for (int i = 0; i < kSamples; ++i) {
    const double depth = 1e-3 * (i + 1) / kSamples;
    f[3 * i + 2] = layer(depth, 0);
    other[3 * i + 2] = layer(depth, 0.1);  // by 6 % of the largest force
    wave[3 * i + 2] = 0.02 * f[kSamples * 3 - 1] * std::sin(20 * depth / 1e-3);
  }
  const double strict = left(d, f, other - f);
  EXPECT_GT(strict, 5);  // what the gain that every place may have does not take
  d.curve_doubt = {0.05};
  EXPECT_LT(left(d, f, other - f), 0.2 * strict);
  // What is no such bend counts as before.
  Dataset none = one_press(kSamples);
  EXPECT_GT(left(d, f, wave), 0.9 * left(none, f, wave));
}

}  // namespace
}  // namespace hapsim
