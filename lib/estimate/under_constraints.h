// Least squares under any smooth constraints between the unknowns: constrained Gauss-Newton.
#pragma once

#include <string>
#include <vector>

#include "estimate/least_squares.h"
#include "estimate/smooth_constraint.h"

namespace hapsim {

struct UnderConstraints {
  LeastSquaresResult fit;      // covariance: along `directions`; 0 across
  std::vector<bool> active;    // one a constraint: it holds with equality
  Eigen::VectorXd multiplier;  // d|r|^2/dg; 0 of those that are not active
  Eigen::VectorXd worth;       // fall of |r|^2 if that active constraint alone were left out, to
                               // second order: r'P r, P onto what J can then do besides
  Eigen::MatrixXd directions;  // m x k: what bounds and active constraints leave of the unknowns
  Eigen::MatrixXd settled;     // one row an active constraint: its slope by the unknowns, of length
                               // one in their steps
};

// Minimises |r|^2 within the bounds and constraints: a step minimises |r + J d|^2 + d'S d under the
// constraints themselves (constrained_step()), so that all but the first keep them (after Bock,
// Bonner Math. Schriften 183, 1987); S, the residuals' own curvature, is learned from the J of the
// points come by. A box about the last point, smaller where |r|^2 falls short of what was foretold,
// keeps steps short. A step costs the residuals and J once. Ends when a step, and what such steps
// have still to go, is below `options.step_tolerance`. max_iterations 0: tells of the start alone.
// No feasible point is found: not converged, and fit.message says so.
UnderConstraints minimise_under(const std::vector<Unknown>& start,
                                const std::vector<SmoothConstraint>& constraints,
                                const ResidualFunction& residuals,
                                const LeastSquaresOptions& options = {});

}  // namespace hapsim
