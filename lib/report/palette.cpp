#include "report/palette.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hapsim {

Rgb error_colour(double share) {
  static constexpr std::array<std::array<double, 3>, 6> kStops{{{255, 245, 214},
                                                                {253, 214, 137},
                                                                {245, 164, 79},
                                                                {222, 104, 57},
                                                                {171, 45, 50},
                                                                {95, 16, 47}}};
  const double x = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(x), kStops.size() - 2);
  const double part = x - static_cast<double>(i);
  Rgb colour{};
  for (int k = 0; k < 3; ++k)
    colour[k] =
        static_cast<std::uint8_t>(std::lround((1 - part) * kStops[i][k] + part * kStops[i + 1][k]));
  return colour;
}

std::string css(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::string version_colour(std::size_t index) {
  static constexpr std::array<const char*, 6> kColours{"#d55e00", "#0072b2", "#009e73",
                                                       "#cc79a7", "#56b4e9", "#b8860b"};
  return kColours[index % kColours.size()];
}

}  // namespace hapsim
