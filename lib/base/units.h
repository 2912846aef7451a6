// Conversion of input units to SI. Inside hapsim everything is m, s, N, Pa, rad, degC.
#pragma once

#include <string>

namespace hapsim {

enum class Quantity { kLength, kTime, kForce, kPressure, kAngle };

// Factor f with value_SI = f * value_unit for a unit name such as "mm", "ms", "mN", "kPa", "deg".
// Throws Error(kUsage) naming the known units of that quantity.
double unit_factor(Quantity quantity, const std::string& unit);

// Names of the known units of a quantity, in the order of the table, e.g. "m mm cm um in".
std::string known_units(Quantity quantity);

}  // namespace hapsim
