// Kernels of relaxation that are no exponential, as sums of some twenty exponentials.
#pragma once

#include <array>
#include <cstddef>

namespace hapsim {

// k(x) = sum_i weight_i exp(-rate_i x), k(0) = 1, x a pure number.
struct MaxwellSpectrum {
  static constexpr std::size_t kSize = 21;
  std::array<double, kSize> rate{}, weight{}, by_shape{};  // by_shape: d weight / d shape
};

// k = (1 + x)^-a, 0 < a <= 1: the power law that begins at x = 1. Within 1e-3 for x up to 1e5.
// Its spectrum is r^(a - 1) exp(-r) / Gamma(a) (Laplace transform of the gamma density).
MaxwellSpectrum power_law_spectrum(double a);

// k = exp(-sqrt x). Within 2e-3 for x up to 25. Its spectrum is that of Levy,
// r^(-3/2) exp(-1/(4 r)) / (2 sqrt pi).
const MaxwellSpectrum& square_root_spectrum();

}  // namespace hapsim
