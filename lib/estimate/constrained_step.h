// One step of least squares under smooth constraints: private to lib/estimate.
#pragma once

#include <optional>
#include <vector>

#include "estimate/stepped_constraint.h"

namespace hapsim {

struct StepBox {
  Eigen::VectorXd low, high;  // bounds of the unknowns that move, in stepped coordinates
  double reach;               // and no further than so from where they are
};

// The least |r + J d|^2 under the constraints themselves, not linearised, about the unknowns x, of
// which those of the numbers `open` move; J by their stepped coordinates. By Newton's method on the
// active set `binds` and what it leads to, with the Hessian 2 J'J and the constraints' exact
// curvature; where that comes to no minimum, by Ipopt (Waechter and Biegler, Math. Program. 106,
// 2006) with the same derivatives, from whose end Newton's method takes the interior point's
// distance. `binds` becomes what does. Returns all unknowns; none where there is no such point.
std::optional<Eigen::VectorXd> constrained_step(const std::vector<SmoothConstraint>& constraints,
                                                const Coordinates& coordinates,
                                                const std::vector<Eigen::Index>& open,
                                                const Eigen::VectorXd& x, const Eigen::MatrixXd& J,
                                                const Eigen::VectorXd& r, const StepBox& box,
                                                std::vector<bool>& binds);

}  // namespace hapsim
