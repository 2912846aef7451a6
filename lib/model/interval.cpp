#include "model/interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effects/catalogue.h"

namespace hapsim {
namespace {

constexpr double kUneven = 0.2;  // above this share of its value an error is no +-

}  // namespace

bool is_logarithmic(const Parameter& p) {
  const Effect* effect = find_effect(p.effect);
  const ParameterCard* card = effect != nullptr ? parameter_card(*effect, p.name) : nullptr;
  return card != nullptr && card->logarithmic && p.value > 0;
}

ParameterInterval interval95(double value, double std_error, bool logarithmic) {
  if (!std::isfinite(std_error)) return {};
  const double half = kHalf95 * std_error;
  if (!logarithmic || !(value > 0)) return {value - half, value + half};
  const double factor = std::exp(half / value);
  return {value / factor, value * factor};
}

ParameterInterval interval95(const Parameter& p) {
  if (p.state == ParameterState::kFixed) return {};
  const bool logarithmic = is_logarithmic(p);
  ParameterInterval interval = interval95(p.value, p.std_error, logarithmic);
  if (!logarithmic || !interval.known()) return interval;
  if (p.lower <= p.value) interval.lower = std::max(interval.lower, p.lower);
  if (p.upper >= p.value) interval.upper = std::min(interval.upper, p.upper);
  return interval;
}

bool tells_interval(double value, double std_error, bool logarithmic) {
  return logarithmic && std_error > kUneven * value;
}

std::string with_interval(double value, const std::string& unit, double std_error,
                          const ParameterInterval& interval, bool logarithmic, int digits,
                          int error_digits) {
  const std::string after = unit == "1" ? "" : " " + unit;
  if (!std::isfinite(std_error)) return fmt::format("{:.{}g}{}", value, digits, after);
  if (!tells_interval(value, std_error, logarithmic))
    return fmt::format("{:.{}g}{} ± {:.{}g}", value, digits, after, std_error, error_digits);
  return fmt::format("{:.{}g}{} (95 %: {:.2g} to {:.2g})", value, digits, after, interval.lower,
                     interval.upper);
}

}  // namespace hapsim
