// Columns that have several names.
#pragma once

#include <string>
#include <vector>

#include "io/csv.h"

namespace hapsim {

// The first of `names` (case ignored) that the table has, as the table writes it; "" for none.
std::string find_column(const CsvTable& table, const std::vector<std::string>& names);

}  // namespace hapsim
