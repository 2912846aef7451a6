#include "linalg/schur_dense.h"

#include <algorithm>

extern "C" {
void dtrmm_(const char* side, const char* triangle, const char* transposed, const char* diagonal,
            const int* m, const int* n, const double* alpha, const double* a, const int* lda,
            double* b, const int* ldb);
void dlauum_(const char* triangle, const int* n, double* a, const int* lda, int* info);
}

namespace hapsim {
namespace {

constexpr int kLeaf = 16;

void invert_leaf(int n, double* a, int lda) {
  const auto at = [&](int i, int j) -> double& {
    return a[i + static_cast<std::ptrdiff_t>(j) * lda];
  };
  for (int j = n - 1; j >= 0; --j) {
    const double d = at(j, j) = 1 / at(j, j);
    for (int i = n - 1; i > j; --i) {
      double sum = 0;
      for (int k = j + 1; k <= i; ++k) sum += at(i, k) * at(k, j);
      at(i, j) = -d * sum;
    }
  }
}

// [L11 0; L21 L22]^-1 = [X11 0; -X22 L21 X11, X22].
void invert_triangle(int n, double* a, int lda) {
  if (n <= kLeaf) return invert_leaf(n, a, lda);
  const int first = n / 2 / 8 * 8, second = n - first;
  double* below = a + first;
  double* corner = below + static_cast<std::ptrdiff_t>(first) * lda;
  invert_triangle(first, a, lda);
  invert_triangle(second, corner, lda);
  const double minus = -1, one = 1;
  dtrmm_("L", "L", "N", "N", &second, &first, &minus, corner, &lda, below, &lda);
  dtrmm_("R", "L", "N", "N", &second, &first, &one, a, &lda, below, &lda);
}

void mirror_lower(Eigen::MatrixXd& a) {
  constexpr Eigen::Index kTile = 64;  // both tiles stay in the cache
  const Eigen::Index n = a.rows();
  for (Eigen::Index c = 0; c < n; c += kTile)
    for (Eigen::Index r = c; r < n; r += kTile)
      for (Eigen::Index j = c; j < std::min(c + kTile, n); ++j)
        for (Eigen::Index i = std::max(r, j + 1); i < std::min(r + kTile, n); ++i)
          a(j, i) = a(i, j);
}

}  // namespace

bool invert_from_cholesky(Eigen::MatrixXd& a) {
  const int n = static_cast<int>(a.rows());
  if (n == 0) return true;
  if (!(a.diagonal().minCoeff() > 0)) return false;
  invert_triangle(n, a.data(), n);
  int info = 0;
  dlauum_("L", &n, a.data(), &n, &info);  // L' L of the lower triangle
  if (info != 0) return false;
  mirror_lower(a);
  return true;
}

}  // namespace hapsim
