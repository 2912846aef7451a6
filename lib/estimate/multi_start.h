// Least squares from many starts, for errors with more than one valley.
#pragma once

#include <vector>

#include "base/random.h"
#include "estimate/least_squares.h"

namespace hapsim {

// `count` starts: the given one, then a Latin hypercube (McKay, Beckman and Conover, Technometrics
// 21, 1979) over the bounds, evenly in the coordinates that are stepped. An unknown without a bound
// on one side is spread over 10 of its scales (or a factor 100) on that side of its value.
std::vector<std::vector<Unknown>> latin_hypercube_starts(const std::vector<Unknown>& unknowns,
                                                         int count, Random& random);

struct MultiStartResult {
  LeastSquaresResult best;  // converged, if any start did; stopped, if the watch ended the search
  int starts = 0;           // that were gone through to their end
  int converged = 0;        // starts that ended in a minimum
  int agreeing = 0;         // starts whose sum of squares is that of the best
  int valleys = 0;          // minima of different sum of squares
};

// Before each start, its number from 0 and the best so far (of infinite sum of squares at first);
// false ends the search.
using StartWatch = std::function<bool(int start, const LeastSquaresResult& best)>;

// Thesis Algorithm 5.6: minimise() from each start, the least sum of squares wins. Sums of squares
// that differ by less than `same` of their mean per residual (or 1e-6 of their own) are one valley.
// A best that few starts reach is doubtful: ask for more.
MultiStartResult minimise_from_many(const std::vector<std::vector<Unknown>>& starts,
                                    const ResidualFunction& residuals,
                                    const LeastSquaresOptions& options = {}, double same = 0.1,
                                    const StartWatch& before_start = {});

}  // namespace hapsim
