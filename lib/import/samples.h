// The numbers of a foreign table in SI units, by role.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "import/column_roles.h"

namespace hapsim {

// What people are told about an import.
struct Notes {
  std::vector<std::string> facts;
  std::vector<std::string> warnings;
};

struct UnitChoice {
  std::string length, force, time;  // for columns whose unit is not named; "" asks for a guess
  bool trusted = false;             // go on where a unit or a size is doubtful
};

// A row's number as an index.
inline std::size_t at(int row) {
  return static_cast<std::size_t>(row);
}

// One entry a row of the table; a role that the table lacks is empty.
struct Samples {
  std::array<std::vector<Vec3>, static_cast<std::size_t>(VectorRole::kCount)> vectors;
  std::array<std::vector<double>, static_cast<std::size_t>(ScalarRole::kCount)> scalars;
  std::vector<std::string> key;  // what names the press; empty when nothing does
  std::vector<int> block;
  bool length_guessed = false, force_guessed = false;  // of some column nothing named the unit
  std::vector<int> usable;  // rows with all numbers that are needed, in the order of the file

  const std::vector<Vec3>& operator[](VectorRole role) const {
    return vectors[static_cast<std::size_t>(role)];
  }
  const std::vector<double>& operator[](ScalarRole role) const {
    return scalars[static_cast<std::size_t>(role)];
  }
};

// Converts all columns that have a role. A unit in the name wins, then `units`, then a guess by
// size, which is a warning. Rows with missing numbers are left out and counted; Error(kBadInput)
// with lines for text in place of a number, and when a fifth of the rows or more would be lost.
// `plane_height` [m] is the z of positions that have x and y only.
Samples load_samples(const RawTable& table, const ColumnMap& map, const UnitChoice& units,
                     double plane_height, Notes& notes);

}  // namespace hapsim
