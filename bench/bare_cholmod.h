// CHOLMOD by itself, as its manual shows it: what the engine's own times stand beside.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "linalg/sparse_cholesky.h"

namespace hapsim::bench {

struct BareTimes {  // seconds of processor time
  double analyse = 0, factorise = 0, solve = 0, invert = 0;
};

// Analyse (its own choice of ordering, supernodal), factorise, three right-hand sides.
BareTimes bare_first_force(const SymmetricSparse& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& x);

// The unknowns `kept` ordered last, METIS before them; LAPACK's dpotri of the factor's last block.
BareTimes bare_schur_inverse(const SymmetricSparse& a, const std::vector<char>& kept,
                             Eigen::MatrixXd& inverse);

}  // namespace hapsim::bench
