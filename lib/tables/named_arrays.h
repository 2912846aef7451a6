// Arrays with names, as MATLAB and HDF5 files hold them, made into one table.
#pragma once

#include <string>
#include <vector>

#include "tables/raw_table.h"

namespace hapsim {

// Numbers in `rows` x `columns`, by rows. The path has its structs or groups: "trial/force"; an
// element of an array of structs is "sites[3]/force".
struct NamedArray {
  std::string path;
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
  std::string unit;  // where the file tells one

  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

// Arrays of one length become columns beside each other (three columns are x, y, z); a value or
// vector that stands alone is repeated in all rows; the elements of an array of structs become
// recordings below each other, named by a column "site", groups with equal names inside by
// "recording". `options.part` takes the arrays below one struct or group. Error(kBadInput) at
// `name`: no array of numbers, or several tables of which --part must take one.
RawTable table_of(std::vector<NamedArray> arrays, const std::string& name,
                  const TableOptions& options);

}  // namespace hapsim
