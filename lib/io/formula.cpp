#include "io/formula.h"

#include "io/number.h"

namespace hapsim {

std::string without_formula(const std::string& text) {
  // Spreadsheets pass over blanks before it.
  const std::size_t first = text.find_first_not_of(" \n");
  double number = 0;
  if (first == text.npos || std::string("=+-@\t\r").find(text[first]) == text.npos ||
      parse_number(text, number))
    return text;
  return "'" + text;
}

}  // namespace hapsim
