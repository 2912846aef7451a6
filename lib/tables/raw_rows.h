// Lines of a text as rows of cells, once the separator is known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hapsim {

struct RawRow {
  long line = 0;  // counted from 1
  std::vector<std::string> cells;
};

// How a missing number is written: empty, "nan", "-", "n/a", "null", "inf".
bool is_missing(std::string_view cell);

// Cells of a line; separator ' ' stands for any run of spaces. Quotes are taken off.
std::vector<std::string> split_cells(std::string_view line, char separator);

// The separator under which most cells of `lines` are numbers in rows of one length; 0 when no
// separator gives two columns of numbers.
char find_separator(const std::vector<std::string_view>& lines);

}  // namespace hapsim
