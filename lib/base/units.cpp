#include "base/units.h"

#include <array>
#include <numbers>

#include "base/error.h"

namespace hapsim {
namespace {

struct Unit {
  Quantity quantity;
  const char* name;
  double factor;
};

constexpr double kDegree = std::numbers::pi / 180;

constexpr std::array kUnits{
    Unit{Quantity::kLength, "m", 1},        Unit{Quantity::kLength, "mm", 1e-3},
    Unit{Quantity::kLength, "cm", 1e-2},    Unit{Quantity::kLength, "um", 1e-6},
    Unit{Quantity::kLength, "in", 0.0254},  Unit{Quantity::kTime, "s", 1},
    Unit{Quantity::kTime, "ms", 1e-3},      Unit{Quantity::kTime, "us", 1e-6},
    Unit{Quantity::kTime, "ns", 1e-9},      Unit{Quantity::kTime, "min", 60},
    Unit{Quantity::kForce, "N", 1},         Unit{Quantity::kForce, "mN", 1e-3},
    Unit{Quantity::kForce, "kN", 1e3},      Unit{Quantity::kForce, "gf", 9.80665e-3},
    Unit{Quantity::kForce, "kgf", 9.80665}, Unit{Quantity::kForce, "lbf", 4.4482216152605},
    Unit{Quantity::kPressure, "Pa", 1},     Unit{Quantity::kPressure, "kPa", 1e3},
    Unit{Quantity::kPressure, "MPa", 1e6},  Unit{Quantity::kAngle, "rad", 1},
    Unit{Quantity::kAngle, "deg", kDegree},
};

}  // namespace

double unit_factor(Quantity quantity, const std::string& unit) {
  for (const Unit& u : kUnits)
    if (u.quantity == quantity && unit == u.name) return u.factor;
  fail_usage("unknown unit '" + unit + "'", "use one of: " + known_units(quantity));
}

std::string known_units(Quantity quantity) {
  std::string names;
  for (const Unit& u : kUnits)
    if (u.quantity == quantity) names += (names.empty() ? "" : " ") + std::string(u.name);
  return names;
}

}  // namespace hapsim
