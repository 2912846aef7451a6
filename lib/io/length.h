// Lengths as people write them.
#pragma once

#include <string>

namespace hapsim {

// "0.004" [m], "4mm" or "4 mm" in metres. Error(kUsage) beginning with `what`: no number, or a unit
// that is not known.
double parse_length(const std::string& text, const std::string& what);

}  // namespace hapsim
