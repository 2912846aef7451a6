// A frequency that stands out of a series with gaps.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

// a sin(2 pi f t) + b cos(2 pi f t)
struct SpectralLine {
  double frequency = 0;                             // f [Hz]; 0: none stands out
  double resolution = 0;                            // how far it may be off [Hz]
  Vec3 sine = Vec3::Zero(), cosine = Vec3::Zero();  // a, b
};

inline constexpr double kNyquist = 2;  // samples in a period

// The line of `values` at times `t` [s] which stands out most of the power about it, in any of the
// three components, if chance makes one as strong once in a thousand series (periodogram: Scargle
// 1982; its level from medians of neighbours, so that broad power, as what a wrong law leaves of
// each press, is none). A line has four periods in the series and `samples` in a period, at least
// kNyquist; of `parts` that the series consists of, few make any line broad, and then its
// neighbours count less. Samples between which no time passes, or fewer than a hundred, have none.
// Memory and time of a Fourier transform of the series with its gaps filled by zeros, of 2^18
// points at most.
SpectralLine find_line(const std::vector<double>& t, const std::vector<Vec3>& values,
                       std::size_t parts, double samples = 4);

}  // namespace hapsim
