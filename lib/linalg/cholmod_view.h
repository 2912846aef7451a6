// Our sparse matrices as CHOLMOD sees them: private to lib/linalg.
#pragma once

#include <cholmod.h>

#include <new>

#include "base/blas.h"
#include "linalg/sparse_cholesky.h"

namespace hapsim {

// A view of our arrays as CHOLMOD's lower-stored matrix; nothing is copied.
inline cholmod_sparse cholmod_view(const SymmetricSparse& matrix) {
  cholmod_sparse a{};
  a.nrow = a.ncol = static_cast<std::size_t>(matrix.size);
  a.nzmax = matrix.row.size();
  a.p = const_cast<int*>(matrix.column_start.data());
  a.i = const_cast<int*>(matrix.row.data());
  a.x = const_cast<double*>(matrix.value.data());
  a.stype = -1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = 1;
  a.packed = 1;
  return a;
}

// Solution of A X = B by a factor of A.
inline Eigen::MatrixXd cholmod_solution(cholmod_factor* factor, const Eigen::MatrixXd& b,
                                        cholmod_common* common) {
  prepare_blas_for_many_threads();
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(b.rows());
  view.ncol = static_cast<std::size_t>(b.cols());
  view.nzmax = view.nrow * view.ncol;
  view.x = const_cast<double*>(b.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor, &view, common);
  if (x == nullptr) throw std::bad_alloc();
  Eigen::MatrixXd result =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), b.rows(), b.cols());
  cholmod_free_dense(&x, common);
  return result;
}

}  // namespace hapsim
