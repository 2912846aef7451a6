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

double parse_length_at(const std::string& where, const std::string& text, const std::string& what) {
  try {
    return parse_length(text, what);
  } catch (const Error& error) {
    const std::string said = error.what();
    throw Error(ExitCode::kBadInput, where, said.rfind(what, 0) == 0 ? said : what + ": " + said,
                "");
  }
}

}  // namespace hapsim
