// What stands below a table: statistics and results that machines append.
#pragma once

#include <vector>

#include "tables/raw_rows.h"

namespace hapsim {

// One past the last row of the table that begins at `first` and has `width` cells a row. Below it
// are at most a few rows of numbers, under a row that begins with a word where the table has
// numbers; a header that is repeated (`header`, or null) begins a further recording instead.
std::size_t table_end(const std::vector<RawRow>& rows, std::size_t first, std::size_t width,
                      const RawRow* header);

}  // namespace hapsim
