// How a residual goes with one quantity: means of groups with their doubt, and rows to draw.
#pragma once

#include <vector>

namespace hapsim {

struct Trend {
  std::vector<double> centre;  // mean x of the group
  std::vector<double> mean;    // of y
  std::vector<double> error;   // standard error of the mean, clustered by press
};

// Up to `groups` groups of about equally many rows along x; rows whose x or y is NaN are left out.
// The standard error is sqrt(C/(C-1) sum_c (sum_i (y_i - mean))^2) / n over the C presses, with one
// press that of independent rows.
Trend binned_trend(const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<int>& press, int groups);

// Rows to draw: at most about `count`, evenly spread, with the highest and lowest y of every
// stretch, in rising order. All rows when there are no more.
std::vector<std::size_t> thinned(const std::vector<double>& y, std::size_t count);

}  // namespace hapsim
