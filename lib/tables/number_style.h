// How a table writes its numbers: decimal point or comma, and what stands between thousands.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hapsim {

struct NumberStyle {
  char decimal = '.';
  char thousands = 0;  // ',', '.', ' ', '\'', 0: nothing
};

// A number in any style: "1234.5", "1.234,56", "1 234,5", "-0,2e-3". With `commas` false those that
// need a comma are none (the comma separates cells).
bool may_be_number(std::string_view cell, bool commas = true);

// A date or a time of day: "2024-05-01", "12:03:01.25", both.
bool may_be_moment(std::string_view cell);

// The cell with a decimal point and nothing between thousands, minus signs and spaces made plain;
// the cell as it is where it is no number of that style.
std::string plain_number(std::string_view cell, const NumberStyle& style);

// Gathers cells until the style is known.
class StyleFinder {
 public:
  void add(std::string_view cell, long line);
  // `told` is "point", "comma" or "" (found). Error(kBadInput) at `name`: both decimal points and
  // decimal commas, or commas of which nothing says whether they stand before decimals or
  // thousands.
  NumberStyle find(const std::string& told, const std::string& name) const;

 private:
  // Where something was seen first, 0: nowhere.
  long decimal_comma_ = 0, decimal_point_ = 0, thousands_comma_ = 0, thousands_point_ = 0,
       thousands_space_ = 0, thousands_mark_ = 0, doubtful_comma_ = 0, doubtful_point_ = 0;
  std::string doubtful_;
};

}  // namespace hapsim
