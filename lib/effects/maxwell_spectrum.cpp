#include "effects/maxwell_spectrum.h"

#include <cmath>

namespace hapsim {
namespace {

// The trapezoidal rule in the logarithm of the rate, whose error falls as exp(-pi^2 / step) for
// densities such as these; weights are brought to a sum of 1.
void normalise(MaxwellSpectrum& s, const std::array<double, MaxwellSpectrum::kSize>& log_by_shape) {
  double sum = 0, mean = 0;
  for (const double w : s.weight) sum += w;
  for (std::size_t i = 0; i < MaxwellSpectrum::kSize; ++i) {
    s.weight[i] /= sum;
    mean += s.weight[i] * log_by_shape[i];
  }
  for (std::size_t i = 0; i < MaxwellSpectrum::kSize; ++i)
    s.by_shape[i] = s.weight[i] * (log_by_shape[i] - mean);
}

}  // namespace

MaxwellSpectrum power_law_spectrum(double a) {
  constexpr double kStep = 1, kFastest = 3;
  MaxwellSpectrum s;
  std::array<double, MaxwellSpectrum::kSize> log_by_shape{};
  for (std::size_t i = 0; i < MaxwellSpectrum::kSize; ++i) {
    const double y = kFastest - kStep * static_cast<double>(MaxwellSpectrum::kSize - 1 - i);
    s.rate[i] = std::exp(y);
    s.weight[i] = std::exp(a * y - s.rate[i]);
    log_by_shape[i] = y;
  }
  // The slowest stands for all that are slower still, which is a geometric series, and hardly
  // moves.
  constexpr double kStill = 1e-6;
  const double ratio = std::exp(-a * kStep);
  s.rate[0] *= kStill;
  s.weight[0] /= 1 - ratio;
  log_by_shape[0] -= kStep * ratio / (1 - ratio);
  normalise(s, log_by_shape);
  return s;
}

const MaxwellSpectrum& square_root_spectrum() {
  static const MaxwellSpectrum spectrum = [] {
    constexpr double kStep = 0.8, kSlowest = -4;
    MaxwellSpectrum s;
    for (std::size_t i = 0; i < MaxwellSpectrum::kSize; ++i) {
      const double y = kSlowest + kStep * static_cast<double>(i);
      s.rate[i] = std::exp(y);
      s.weight[i] = std::exp(-y / 2 - std::exp(-y) / 4);
    }
    s.weight.back() /= 1 - std::exp(-kStep / 2);  // for all that are faster still
    normalise(s, {});
    return s;
  }();
  return spectrum;
}

}  // namespace hapsim
