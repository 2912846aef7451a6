// Axes with round numbers.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

struct Ticks {
  double lower = 0, upper = 1;  // range that takes in all data
  std::vector<double> at;       // multiples of 1, 2 or 5 times a power of ten, within the range
  int decimals = 0;
  std::string label(double tick) const;
};

// About `count` ticks for data from `low` to `high`. The range ends at ticks when `round` is set,
// else at the data. A single value gets a range about it; NaN or infinity count as 0.
Ticks nice_ticks(double low, double high, int count, bool round);

}  // namespace hapsim
