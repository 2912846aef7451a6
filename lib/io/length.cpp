#include "io/length.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "io/number.h"

namespace hapsim {

double parse_length(const std::string& text, const std::string& what) {
  const std::string_view all = trim(text);
  const std::size_t letters = std::min(all.find_first_not_of("+-.0123456789eE"), all.size());
  double value;
  if (!parse_number(all.substr(0, letters), value))
    fail_usage(what + ": '" + text + "' is no length", "write for example 4mm or 0.004");
  const std::string unit(trim(all.substr(letters)));
  return value * (unit.empty() ? 1 : unit_factor(Quantity::kLength, unit));
}

}  // namespace hapsim
