#include "io/quantity.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr const char* kOfNumbers = "+-.0123456789eE";

// The number and the unit of "4 mm"; false when it does not begin with a number.
bool split(const std::string& text, std::string& number, std::string& unit) {
  const std::string_view all = trim(text);
  const std::size_t letters = std::min(all.find_first_not_of(kOfNumbers), all.size());
  number = trim(all.substr(0, letters));
  unit = trim(all.substr(letters));
  double value;
  return parse_number(number, value);
}

// number * factor; a power of ten shifts the number's own exponent, so that 1.1mm is 0.0011 to the
// last bit.
double scaled(const std::string& number, double factor) {
  const auto shift = static_cast<int>(std::lround(std::log10(factor)));
  double value = 0;
  if (factor == std::pow(10, shift)) {
    const std::size_t e = std::min(number.find_first_of("eE"), number.size());
    const char* from = number.data() + e + (e < number.size() ? 1 : 0);
    if (from < number.data() + number.size() && *from == '+') ++from;
    int exponent = 0;
    const bool read =
        e == number.size() ||
        std::from_chars(from, number.data() + number.size(), exponent).ec == std::errc();
    if (read && std::abs(exponent) < 1000 &&
        parse_number(number.substr(0, e) + "e" + std::to_string(exponent + shift), value))
      return value;
  }
  parse_number(number, value);
  return value * factor;
}

double in_si(const std::string& number, const std::string& unit, Quantity quantity,
             const std::string& what) {
  try {
    return scaled(number, unit.empty() ? 1 : unit_factor(quantity, unit));
  } catch (const Error& error) {
    throw Error(error.code(), "", what + ": " + error.what(), "");
  }
}

}  // namespace

const QuantityWords& words_of(Quantity quantity) {
  static const QuantityWords kWords[] = {{"length", "m", "0.004 or 4mm"},
                                         {"time", "s", "0.5 or 500ms"},
                                         {"force", "N", "0.02 or 20mN"},
                                         {"pressure", "Pa", "3000 or 3kPa"},
                                         {"angle", "rad", "0.5 or 30deg"}};
  return kWords[static_cast<int>(quantity)];
}

double parse_quantity(const std::string& text, Quantity quantity, const std::string& what) {
  std::string number, unit;
  if (!split(text, number, unit))
    fail_usage(what + ": '" + text + "' is no " + words_of(quantity).name,
               std::string("write for example ") + words_of(quantity).example);
  return in_si(number, unit, quantity, what);
}

double parse_length(const std::string& text, const std::string& what) {
  return parse_quantity(text, Quantity::kLength, what);
}

double parse_length_at(const std::string& where, const std::string& text, const std::string& what) {
  try {
    return parse_length(text, what);
  } catch (const Error& error) {
    throw Error(ExitCode::kBadInput, where, error.what(), "");
  }
}

std::string list_in_si(const std::string& text, const std::vector<Quantity>& quantities,
                       const std::string& what) {
  struct Part {
    std::string number, unit;
    Quantity quantity;
    std::string after;  // what parts it from the next
  };
  std::vector<Part> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find_first_of(",:xX", from), text.size());
    Part part;
    part.quantity = quantities[std::min(parts.size(), quantities.size() - 1)];
    if (!split(text.substr(from, to - from), part.number, part.unit)) return text;
    part.after = text.substr(to, to < text.size() ? 1 : 0);
    parts.push_back(std::move(part));
    from = to + 1;
  }
  if (std::all_of(parts.begin(), parts.end(), [](const Part& p) { return p.unit.empty(); }))
    return text;
  std::string result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const auto next =
        std::find_if(parts.begin() + static_cast<std::ptrdiff_t>(i), parts.end(),
                     [&](const Part& p) { return p.quantity == part.quantity && !p.unit.empty(); });
    const std::string unit = next == parts.end() ? "" : next->unit;
    result += format_number(in_si(part.number, unit, part.quantity, what)) + part.after;
  }
  return result;
}

}  // namespace hapsim
