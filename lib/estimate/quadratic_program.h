// Small convex quadratic programs: private to lib/estimate.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hapsim {

// The least d'H d / 2 + f'd (H of n x n, positive definite) with A d = b in the rows of A that are
// equalities and A d >= b in the others.
struct QuadraticProgram {
  Eigen::MatrixXd H, A;
  Eigen::VectorXd f, b;
  std::vector<bool> equality;  // one a row
};
struct QuadraticEnd {
  Eigen::VectorXd d, multiplier;  // H d + f = A' multiplier; >= 0 of inequalities
};

// The dual active set of Goldfarb and Idnani (Math. Program. 27, 1983), each step by a QR anew of
// what is active. None: no d keeps all rows, or rounding hides it.
std::optional<QuadraticEnd> solve(const QuadraticProgram& program);

}  // namespace hapsim
