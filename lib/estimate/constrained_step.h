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

struct ConstrainedStep {
  Eigen::VectorXd x;  // all unknowns
  double fall;        // of |q + R d|^2 + d'S d
};

// The least |q + R d|^2 + d'S d under the constraints themselves, not linearised, about the
// unknowns x, of which those of the numbers `open` move; R (of those) and S by their stepped
// coordinates. S may be empty, and bend down: then a local minimum. By Newton's method on the
// active set `binds` and what it leads to, with the constraints' exact curvature; where that comes
// to no minimum, after sequential quadratic programming (Nocedal and Wright, Numerical
// Optimization, 18.4), from whose end Newton's method goes on; where that does not either, without
// S and after Ipopt (Waechter and Biegler, Math. Program. 106, 2006). `binds` becomes what does.
// None where there is no such point.
std::optional<ConstrainedStep> constrained_step(const std::vector<SmoothConstraint>& constraints,
                                                const Coordinates& coordinates,
                                                const std::vector<Eigen::Index>& open,
                                                const Eigen::VectorXd& x, const Eigen::MatrixXd& R,
                                                const Eigen::VectorXd& q, const Eigen::MatrixXd& S,
                                                const StepBox& box, std::vector<bool>& binds);

}  // namespace hapsim
