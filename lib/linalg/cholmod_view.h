// Our sparse matrices as CHOLMOD sees them: private to lib/linalg.
#pragma once

#include <cholmod.h>

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

}  // namespace hapsim
