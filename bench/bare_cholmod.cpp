#include "bare_cholmod.h"

#include <cholmod.h>

#include <algorithm>

#include "linalg/cholmod_view.h"
#include "whole_run.h"

extern "C" void dpotri_(const char* triangle, const int* n, double* a, const int* lda, int* info);

namespace hapsim::bench {
namespace {

struct Common {
  cholmod_common common{};
  Common() {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~Common() { cholmod_finish(&common); }
};

}  // namespace

BareTimes bare_first_force(const SymmetricSparse& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
  Common c;
  cholmod_sparse view = cholmod_view(a);
  BareTimes times;
  const double start = processor_seconds();
  cholmod_factor* factor = cholmod_analyze(&view, &c.common);
  const double analysed = processor_seconds();
  cholmod_factorize(&view, factor, &c.common);
  const double factorised = processor_seconds();
  cholmod_dense right{};
  right.nrow = right.d = static_cast<std::size_t>(b.rows());
  right.ncol = static_cast<std::size_t>(b.cols());
  right.nzmax = right.nrow * right.ncol;
  right.x = const_cast<double*>(b.data());
  right.xtype = CHOLMOD_REAL;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, &right, &c.common);
  times = {analysed - start, factorised - analysed, processor_seconds() - factorised, 0};
  x = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution->x), b.rows(),
                                        b.cols());
  cholmod_free_dense(&solution, &c.common);
  cholmod_free_factor(&factor, &c.common);
  return times;
}

BareTimes bare_schur_inverse(const SymmetricSparse& a, const std::vector<char>& kept,
                             Eigen::MatrixXd& inverse) {
  Common c;
  cholmod_sparse view = cholmod_view(a);
  BareTimes times;
  const double start = processor_seconds();
  // METIS on the unknowns that are not kept.
  SymmetricSparse inner;
  std::vector<int> number(kept.size(), -1), order, last;
  for (int i = 0; i < a.size; ++i) {
    if (kept[i]) {
      last.push_back(i);
      continue;
    }
    number[i] = inner.size++;
  }
  inner.column_start.push_back(0);
  std::vector<int> eliminated;
  for (int i = 0; i < a.size; ++i) {
    if (kept[i]) continue;
    eliminated.push_back(i);
    for (int k = a.column_start[i]; k < a.column_start[i + 1]; ++k)
      if (number[a.row[k]] >= 0) inner.row.push_back(number[a.row[k]]);
    inner.column_start.push_back(static_cast<int>(inner.row.size()));
  }
  inner.value.assign(inner.row.size(), 1.0);
  cholmod_sparse inner_view = cholmod_view(inner);
  std::vector<int> permutation(static_cast<std::size_t>(inner.size));
  cholmod_metis(&inner_view, nullptr, 0, 1, permutation.data(), &c.common);
  for (int& p : permutation) p = eliminated[p];
  permutation.insert(permutation.end(), last.begin(), last.end());
  c.common.nmethods = 1;
  c.common.method[0].ordering = CHOLMOD_GIVEN;
  c.common.postorder = 0;
  cholmod_factor* factor = cholmod_analyze_p(&view, permutation.data(), nullptr, 0, &c.common);
  const double analysed = processor_seconds();
  cholmod_factorize(&view, factor, &c.common);
  const double factorised = processor_seconds();
  const int n = static_cast<int>(last.size());
  inverse.setZero(n, n);
  const int first = a.size - n;
  const int* super = static_cast<const int*>(factor->super);
  const int* start_of = static_cast<const int*>(factor->pi);
  const int* values = static_cast<const int*>(factor->px);
  const int* rows = static_cast<const int*>(factor->s);
  const double* x = static_cast<const double*>(factor->x);
  for (std::size_t s = 0; s < factor->nsuper; ++s) {
    const int height = start_of[s + 1] - start_of[s];
    for (int column = super[s]; column < super[s + 1]; ++column)
      for (int i = column - super[s]; column >= first && i < height; ++i)
        inverse(rows[start_of[s] + i] - first, column - first) =
            x[values[s] + static_cast<std::ptrdiff_t>(column - super[s]) * height + i];
  }
  int info = 0;
  dpotri_("L", &n, inverse.data(), &n, &info);
  times = {analysed - start, factorised - analysed, 0, processor_seconds() - factorised};
  cholmod_free_factor(&factor, &c.common);
  return times;
}

}  // namespace hapsim::bench
