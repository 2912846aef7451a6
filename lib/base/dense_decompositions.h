// Eigen's dense decompositions that several rooms use, compiled once, in this room: the precompiled
// header has them declared, so no other unit spends seconds on each. What does without it compiles
// them as ever.
#pragma once

#include <Eigen/Dense>

namespace Eigen {

extern template class JacobiSVD<MatrixXd>;
extern template class ColPivHouseholderQR<MatrixXd>;
extern template class CompleteOrthogonalDecomposition<MatrixXd>;
extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

}  // namespace Eigen
