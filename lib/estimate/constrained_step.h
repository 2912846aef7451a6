// One step of least squares under smooth constraints.
#pragma once

#include <optional>
#include <vector>

#include "estimate/smooth_constraint.h"

namespace hapsim {

struct StepBox {
  Eigen::VectorXd low, high;  // bounds of the unknowns that move, in stepped coordinates
  double reach;               // and no further than so from where they are
};

// The least |r + J d|^2 under the constraints themselves, not linearised, about the unknowns x, of
// which those of the numbers `open` move; J by their stepped coordinates. By Ipopt (Waechter and
// Biegler, Math. Program. 106, 2006) with the Hessian 2 J'J and the constraints' exact curvature,
// then by Newton's method on the active set, which takes the interior point's distance from it
// away. Returns all unknowns; none where Ipopt has no such point. Ipopt sees J's triangle alone.
std::optional<Eigen::VectorXd> constrained_step(const std::vector<SmoothConstraint>& constraints,
                                                const Coordinates& coordinates,
                                                const std::vector<Eigen::Index>& open,
                                                const Eigen::VectorXd& x, const Eigen::MatrixXd& J,
                                                const Eigen::VectorXd& r, const StepBox& box);

}  // namespace hapsim
