// Powers of one coordinate with their first and second derivatives.
#pragma once

#include <array>

namespace hapsim {

struct PowerTable {
  static constexpr int kMost = 6;
  explicit PowerTable(double x) noexcept {
    f[0] = 1;
    for (int p = 1; p <= kMost; ++p) f[p] = f[p - 1] * x;
    for (int p = 0; p <= kMost; ++p) {
      d[p] = p > 0 ? p * f[p - 1] : 0;
      dd[p] = p > 1 ? p * (p - 1) * f[p - 2] : 0;
    }
  }
  std::array<double, kMost + 1> f, d, dd;
};

}  // namespace hapsim
