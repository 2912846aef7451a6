// Those entries of a sparse matrix' inverse that stand on its own pattern.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "linalg/sparse_cholesky.h"

namespace hapsim {

// A^-1 at the entries of A's lower triangle, in the order of matrix.value; empty where A is not
// positive definite. The entries on the factor's pattern are computed, from its last columns to its
// first (Takahashi, Fagan and Chen, 8th PICA Conference, 1973; Erisman and Tinney, Comm. ACM 18,
// 1975), supernode by supernode. `order`: SparseCholesky::order() of the same pattern with blocks
// of one. Cost: some four factorisations, and the factor's memory twice.
Eigen::VectorXd inverse_on_pattern(const SymmetricSparse& matrix, const std::vector<int>& order);

}  // namespace hapsim
