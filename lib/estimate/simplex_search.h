// The minimum of a function of few variables whose derivatives are not at hand.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace hapsim {

struct SimplexSearchOptions {
  double first_step = 1;       // of each variable
  double tolerance = 1e-3;     // largest difference between the corners at the end, each variable
  double value_tolerance = 0;  // or of their values
  int most_evaluations = 600;
};

struct SimplexSearchResult {
  Eigen::VectorXd x;
  double value = 0;
  int evaluations = 0;
  bool converged = false;
};

// The downhill simplex of Nelder and Mead (Comput. J. 7, 1965), started again from its end until a
// new start gains nothing, since a simplex can shrink before it is there. Values that are not
// finite count as worse than all others.
SimplexSearchResult simplex_search(const Eigen::VectorXd& start,
                                   const std::function<double(const Eigen::VectorXd&)>& function,
                                   const SimplexSearchOptions& options = {});

}  // namespace hapsim
