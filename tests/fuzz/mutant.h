// Damaged copies of valid files.
#pragma once

#include <string>

#include "base/random.h"

namespace hapsim::fuzz {

// `good` with some of what damages files: bytes changed, removed, repeated, cut off at the end;
// numbers made huge, negative, fractional or none; lines and cells missing, twice or in another
// place.
std::string mutant(const std::string& good, Random& random);

}  // namespace hapsim::fuzz
