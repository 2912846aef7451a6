// Medians and quantiles of samples in any order. None of them may be NaN.
#pragma once

#include <cstddef>
#include <vector>

namespace hapsim {

// The element with `rank` others before it in ascending order; the largest when there are not so
// many. 0 of none.
double nth_smallest(std::vector<double> values, std::size_t rank);

// The element that `share` (0 to 1) of the others lie below: of n, that of rank share (n - 1),
// rounded down. Always one of the values. 0 of none.
double quantile(std::vector<double> values, double share);

// The middle element; of an even number the mean of the two middle ones. 0 of none.
double median(std::vector<double> values);

// The middle element; of an even number the upper of the two middle ones, so that it is always one
// of the values. Of few samples it lies above `median`, by half their spacing. 0 of none.
double upper_median(std::vector<double> values);

}  // namespace hapsim
