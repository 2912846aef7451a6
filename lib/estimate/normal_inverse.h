// The inverse of the normal equations' matrix.
#pragma once

#include <Eigen/Core>

namespace hapsim {

// (J'J)^-1 in the directions that J, n x m, sees, 0 in the others (Moore and Penrose's inverse),
// from the triangle of J's QR decomposition: memory of n m numbers, where J's own inverse with its
// orthogonal factor takes n^2.
Eigen::MatrixXd normal_inverse(Eigen::MatrixXd J);

}  // namespace hapsim
