// Conjugate gradients preconditioned by an incomplete Cholesky factor, for systems that are too
// large to factorise or change too often.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "linalg/sparse_cholesky.h"

namespace hapsim {

struct IterationReport {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|
};

// Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49, 1952; IC(0) of the symmetrically scaled
// matrix (Meijerink and van der Vorst, Math. Comput. 31, 1977), its diagonal raised until it exists
// (Manteuffel, Math. Comput. 34, 1980). Memory: the matrix once more. Not to be shared between
// threads.
class ConjugateGradients {
 public:
  // Factorises incompletely. False when the diagonal is not positive.
  bool prepare(const SymmetricSparse& matrix);
  // Solves A x = b from the given x; A must be the matrix prepared, or close to it (a
  // preconditioner may serve several Newton steps). Stops at |b - A x| <= tolerance |b| or after
  // `limit` steps (0: ten times the square root of the size, at least 1000); not converged is
  // reported, not thrown.
  IterationReport solve(const SymmetricSparse& matrix, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                        double tolerance = 1e-8, int limit = 0) const;
  double shift() const { return shift_; }  // by which the unit diagonal was raised

 private:
  bool factorise(double shift);
  Eigen::VectorXd preconditioned(const Eigen::VectorXd& r) const;

  SymmetricSparse factor_;      // lower triangle of IC(0) of the scaled matrix
  std::vector<double> scaled_;  // values of the scaled matrix
  Eigen::VectorXd scale_;       // 1 / sqrt(diagonal)
  double shift_ = 0;
};

// A x of a lower-stored symmetric matrix.
Eigen::VectorXd multiply(const SymmetricSparse& matrix, const Eigen::VectorXd& x);

}  // namespace hapsim
