#include "base/random.h"

#include <cmath>
#include <numbers>

namespace hapsim {

double Random::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  const double angle = 2 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::uint64_t Random::integer(std::uint64_t n) {
  // Rejection keeps every value equally likely.
  const std::uint64_t limit = n * (UINT64_MAX / n);
  std::uint64_t draw;
  do draw = engine_();
  while (draw >= limit);
  return draw % n;
}

}  // namespace hapsim
