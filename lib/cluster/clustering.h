// Agglomerative clustering of numbers with known errors.
#pragma once

#include <vector>

namespace hapsim {

// Ward's method (Ward, 1963) on one-dimensional values weighted by 1/error^2: merges until
// `clusters` are left and gives each value's cluster, numbered by ascending mean.
std::vector<int> ward_clusters(const std::vector<double>& values, const std::vector<double>& errors,
                               int clusters);

}  // namespace hapsim
