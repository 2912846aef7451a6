// Colours of the report, told apart also by the colour-blind.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace hapsim {

using Rgb = std::array<std::uint8_t, 3>;

inline constexpr Rgb kUnknownColour{188, 193, 199};  // no measurement near

// Error colours from pale (0) to dark red (1), lightness falling all the way; clamped.
Rgb error_colour(double share);
// Blue (-1) over pale (0) to red (1), for what is above or below; clamped.
Rgb signed_colour(double share);
// Of the k-th kind of something, from 0 (Okabe & Ito 2008).
Rgb kind_colour(std::size_t k);
std::string css(const Rgb& colour);

// Line colours of simulated versions (Okabe & Ito 2008); the compared one is always the first.
std::string version_colour(std::size_t index);

}  // namespace hapsim
