#include "report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hapsim {

std::string Ticks::label(double tick) const {
  const double shown = std::abs(tick) < 1e-9 * (upper - lower) ? 0 : tick;
  const double largest = std::max(std::abs(lower), std::abs(upper));
  if (largest >= 1e6 || decimals > 6) return fmt::format("{:.3g}", shown);
  std::string text = fmt::format("{:.{}f}", shown, decimals);
  if (text[0] == '-') text.replace(0, 1, "\xe2\x88\x92");  // a minus sign as wide as a plus
  return text;
}

Ticks nice_ticks(double low, double high, int count, bool round) {
  if (!std::isfinite(low)) low = 0;
  if (!std::isfinite(high)) high = 0;
  if (low > high) std::swap(low, high);
  if (high - low <= 1e-12 * std::max(std::abs(low), std::abs(high)) || high == low) {
    const double half = low == 0 ? 1 : 0.5 * std::abs(low);
    low -= half;
    high += half;
  }
  const double raw = (high - low) / std::max(1, count);
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double step = power * (raw / power <= 1.5   ? 1
                               : raw / power <= 3.5 ? 2
                               : raw / power <= 7.5 ? 5
                                                    : 10);
  Ticks ticks;
  const double first = std::floor(low / step + 1e-9), last = std::ceil(high / step - 1e-9);
  ticks.lower = round ? first * step : low;
  ticks.upper = round ? last * step : high;
  for (double k = first; k <= last; ++k) {
    const double at = k * step;
    if (at >= ticks.lower - 1e-9 * step && at <= ticks.upper + 1e-9 * step) ticks.at.push_back(at);
  }
  ticks.decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return ticks;
}

}  // namespace hapsim
