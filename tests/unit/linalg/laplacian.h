// A matrix for the tests of solvers.
#pragma once

#include "linalg/sparse_cholesky.h"

namespace hapsim {

// Laplace's equation on n^3 points with a contrast of 100 between two halves: seven-point stencil.
inline SymmetricSparse laplacian(int n) {
  SymmetricSparse a;
  a.size = n * n * n;
  a.column_start.push_back(0);
  const auto conductivity = [n](int i) { return i < n / 2 ? 1.0 : 100.0; };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int c = (k * n + j) * n + i;
        const double here = conductivity(i);
        // A face between two cells has their harmonic mean; walls all around.
        const auto between = [&](int other) {
          if (other < 0 || other >= n) return here;
          const double there = conductivity(other);
          return 2 * here * there / (here + there);
        };
        a.row.push_back(c);
        a.value.push_back(4 * here + between(i - 1) + between(i + 1));
        if (i + 1 < n) a.row.push_back(c + 1), a.value.push_back(-between(i + 1));
        if (j + 1 < n) a.row.push_back(c + n), a.value.push_back(-here);
        if (k + 1 < n) a.row.push_back(c + n * n), a.value.push_back(-here);
        a.column_start.push_back(static_cast<int>(a.row.size()));
      }
  return a;
}

}  // namespace hapsim
