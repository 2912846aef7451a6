// Least squares under linear constraints between the unknowns, by an interior point method.
#pragma once

#include <string>
#include <vector>

#include "estimate/least_squares.h"

namespace hapsim {

// lower <= sum of coefficient_i y_i <= upper, y the unknowns as they are stepped: x / scale, or
// log x of a logarithmic one (so that log tau2 - log tau1 >= log 3 keeps relaxation times apart).
struct LinearConstraint {
  std::vector<double> coefficient;  // one an unknown
  double lower = -1e300;
  double upper = 1e300;
};

struct ConstrainedResult {
  LeastSquaresResult fit;    // covariance: along the constraints that are not active
  std::vector<bool> active;  // one a constraint
};

// Minimises |r|^2 within bounds and constraints by Ipopt (Waechter and Biegler, Math. Program. 106,
// 2006) with the Gauss-Newton matrix 2 J'J for the Hessian. Threads take turns (its linear solver
// is not thread-safe). A start outside the constraints is allowed. Constraints without a feasible
// point, or no convergence, are reported in fit.message.
ConstrainedResult minimise_constrained(const std::vector<Unknown>& start,
                                       const std::vector<LinearConstraint>& constraints,
                                       const ResidualFunction& residuals,
                                       const LeastSquaresOptions& options = {});

// Each of the logarithmic unknowns `ordered` at least `ratio` times the one before: disjoint
// windows of relaxation times (thesis 5.4.2). `count` is the number of all unknowns.
std::vector<LinearConstraint> keep_apart(std::size_t count, const std::vector<std::size_t>& ordered,
                                         double ratio);

}  // namespace hapsim
