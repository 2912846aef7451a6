// Unilateral contact with Coulomb friction as a small dense problem.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

// Signorini's and Coulomb's conditions at m places, each with a normal and two tangential parts
// (rows 3 i, 3 i + 1, 3 i + 2):
//   w = C p + w0,   w_n >= 0, p_n >= 0, w_n p_n = 0,   |p_t| <= mu p_n,
//   w_t = 0 where |p_t| < mu p_n, else p_t against w_t.
// p: tractions of the tool on the body, w: how far it is apart and has slipped, w0: without
// tractions, C: symmetric positive definite. mu, one a place: 0 without friction, infinite where
// what touches sticks. Semismooth Newton's method on the equations of Alart and Curnier (Comput.
// Methods Appl. Mech. Eng. 92, 1991) in the active-set form of Hueeber, Stadler and Wohlmuth (SIAM
// J. Sci. Comput. 30, 2008), with sweeps of projected relaxation where it cycles. Exact but for
// rounding. `traction` (3 m): start and result. False when neither settles.
bool solve_coulomb_contact(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& apart,
                           const std::vector<double>& friction, Eigen::VectorXd& traction);

}  // namespace hapsim
