#include "report/palette.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hapsim {

namespace {

using Stops = std::array<std::array<double, 3>, 6>;

Rgb between(const Stops& stops, double share) {
  const double x = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(x), stops.size() - 2);
  const double part = x - static_cast<double>(i);
  Rgb colour{};
  for (int k = 0; k < 3; ++k)
    colour[k] =
        static_cast<std::uint8_t>(std::lround((1 - part) * stops[i][k] + part * stops[i + 1][k]));
  return colour;
}

}  // namespace

Rgb error_colour(double share) {
  static constexpr Stops kStops{{{255, 245, 214},
                                 {253, 214, 137},
                                 {245, 164, 79},
                                 {222, 104, 57},
                                 {171, 45, 50},
                                 {95, 16, 47}}};
  return between(kStops, share);
}

Rgb signed_colour(double share) {
  static constexpr Stops kStops{
      {{5, 48, 97}, {67, 147, 195}, {214, 230, 240}, {250, 224, 208}, {214, 96, 77}, {103, 0, 31}}};
  return between(kStops, 0.5 + 0.5 * share);
}

Rgb kind_colour(std::size_t k) {
  static constexpr std::array<Rgb, 6> kColours{{{86, 180, 233},
                                                {230, 159, 0},
                                                {0, 158, 115},
                                                {204, 121, 167},
                                                {240, 228, 66},
                                                {0, 114, 178}}};
  return kColours[k % kColours.size()];
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
