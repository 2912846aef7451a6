// Lengths as people write them.
#pragma once

#include <string>

namespace hapsim {

// "0.004" [m], "4mm" or "4 mm" in metres. Error(kUsage) beginning with `what`: no number, or a unit
// that is not known.
double parse_length(const std::string& text, const std::string& what);
// The same of a length that a file holds: Error(kBadInput) at `where`.
double parse_length_at(const std::string& where, const std::string& text, const std::string& what);

}  // namespace hapsim
