// Intervals that do not assume a parabola: the profile of the likelihood.
#pragma once

#include <vector>

#include "estimate/least_squares.h"

namespace hapsim {

struct ProfileInterval {
  double lower = 0, upper = 0;  // the bound of the unknown where the interval is open
  bool open_below = false;      // the data allow every value down to the bound
  bool open_above = false;
  bool failed = false;  // a fit on the way did not converge
};

// Values of unknown `which` at which the least sum of squares over all others exceeds the minimum
// by `rise` times `variance` (that of the whitened residuals: 1, or larger where the misfit is):
// 3.84 for 95 % (Venzon and Moolgavkar, Appl. Statist. 37, 1988). `at` is the minimum found from
// `unknowns`. Some ten fits a side.
ProfileInterval profile_interval(const std::vector<Unknown>& unknowns,
                                 const ResidualFunction& residuals, const LeastSquaresResult& at,
                                 std::size_t which, double variance = 1, double rise = 3.841458821,
                                 const LeastSquaresOptions& options = {});

}  // namespace hapsim
