#include "tables/trailing_block.h"

#include <algorithm>
#include <cctype>

#include "tables/number_style.h"

namespace hapsim {
namespace {

bool is_text(const std::string& cell) {
  return !is_missing(cell) && !may_be_number(cell) &&
         !std::isdigit(static_cast<unsigned char>(cell[0]));
}

// The first column that holds numbers, by the first rows of the table.
std::size_t first_of_numbers(const std::vector<RawRow>& rows, std::size_t first,
                             std::size_t width) {
  std::vector<std::size_t> numbers(width, 0);
  std::size_t seen = 0;
  for (std::size_t i = first; i < rows.size() && seen < 50; ++i) {
    if (rows[i].cells.size() != width) continue;
    ++seen;
    for (std::size_t c = 0; c < width; ++c) numbers[c] += may_be_number(rows[i].cells[c]);
  }
  for (std::size_t c = 0; c < width; ++c)
    if (2 * numbers[c] > seen) return c;
  return 0;
}

}  // namespace

std::size_t table_end(const std::vector<RawRow>& rows, std::size_t first, std::size_t width,
                      const RawRow* header) {
  const std::size_t lead = first_of_numbers(rows, first, width);
  const auto data = [&](const RawRow& row) {
    return row.cells.size() == width && may_be_number(row.cells[lead]);
  };
  // From the end: the first labelled row below which few rows of numbers stand.
  const std::size_t few = std::max<std::size_t>(3, (rows.size() - first) / 50);
  std::size_t end = rows.size(), below = 0, labels = 0;
  for (std::size_t i = rows.size(); i-- > first + 1;) {
    const RawRow& row = rows[i];
    if (header && row.cells == header->cells) return rows.size();
    if (data(row)) {
      if (++below > few) break;
      continue;
    }
    const std::string& label = row.cells[std::min(lead, row.cells.size() - 1)];
    // A row whose label stands in its first cell, as a row of statistics has it.
    if (is_text(row.cells[0]) && (row.cells.size() != width || is_text(label) || label.empty())) {
      end = i;
      ++labels;
    }
  }
  return labels > 0 ? end : rows.size();
}

}  // namespace hapsim
