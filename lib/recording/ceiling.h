// Where a force sensor's readings end.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

// So many readings that are the same to the last digit are an end of the range, not chance.
inline constexpr std::size_t kLeastAtCeiling = 5;

// Of one axis: the largest size of a reading [N], and how many readings are exactly that.
struct Ceiling {
  double force = 0;
  std::size_t readings = 0;
  bool reached() const { return readings >= kLeastAtCeiling && force > 0; }
};

// Of x, y and z. Where a sensor ends the noise is cut off as well, so that readings there are the
// same to the last digit (to 1e-6, for those that were converted). O(rows).
std::array<Ceiling, 3> find_ceilings(const std::vector<Vec3>& forces);

// "133 readings of z are exactly 1.0000 N in size, the largest"; "" where no axis is at its end.
std::string ceiling_words(const std::array<Ceiling, 3>& ceilings);

}  // namespace hapsim
