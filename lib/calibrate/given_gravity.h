// Gravity as people give it.
#pragma once

#include <optional>
#include <string>

#include "base/vec3.h"

namespace hapsim {

// "0,0,-9.80665" [m/s2] in the base; none for "estimate". Error(kUsage) beginning with `what`: not
// three numbers, or a length that is no gravity (a direction of length 1?).
std::optional<Vec3> given_gravity(const std::string& text, const std::string& what);

}  // namespace hapsim
