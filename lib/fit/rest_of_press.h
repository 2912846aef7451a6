// Training on the beginning of each press, and the error on what comes later.
#pragma once

#include <vector>

#include "fit/fit.h"

namespace hapsim {

// The rows up to `seconds` after their press's first row; the same of `setup_of_row`, unless that
// is empty. Error(kBadInput): no times, nothing later than that, or `recovery: none` (what a press
// remembers would be lost).
Recording beginning_of_presses(const Recording& recording, double seconds,
                               std::vector<Setup>& setup_of_row);

// On the rows after `seconds`, forces compared as vectors.
struct LaterError {
  double rmse = 0;       // per component [N]
  double median = 0;     // of |measured - model| over the peak |measured| of the press
  std::size_t rows = 0;  // so many
};
// `whole`: the recording uncut, with its normals; its positions are those of the experiment that
// was fitted.
LaterError later_error(const Fit& fitted, const Dataset& whole, double seconds);

}  // namespace hapsim
