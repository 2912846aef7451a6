// Whether constraints leave any point, and which of them contradict each other where they do not.
#pragma once

#include <optional>
#include <vector>

#include "estimate/least_squares.h"
#include "estimate/smooth_constraint.h"

namespace hapsim {

// Whether the values of the unknowns keep all constraints, to `near` of their steps.
bool keeps(const std::vector<Unknown>& at, const std::vector<SmoothConstraint>& constraints,
           double near = 1e-9);

// A point within the bounds that keeps all constraints, near the start: the least sum of squares of
// what each is broken by (elastic slacks), from the start and then from 24 points within the bounds
// (six typical changes, or e^6, each way). None: no such point was found; where the constraints are
// linear in the stepped coordinates there is none.
std::optional<Eigen::VectorXd> feasible_point(const std::vector<Unknown>& start,
                                              const std::vector<SmoothConstraint>& constraints);

// Constraints and bounds that contradict each other, none of which could be left out.
struct Conflict {
  std::vector<std::size_t> constraints;
  std::vector<std::size_t> lower, upper;  // unknowns, whose bound it is
};
// Of constraints without a feasible point: a deletion filter (Chinneck and Dravnieks, ORSA J.
// Comput. 3, 1991), over the constraints and then over the bounds of what these see.
Conflict find_conflict(const std::vector<Unknown>& start,
                       const std::vector<SmoothConstraint>& constraints);

}  // namespace hapsim
