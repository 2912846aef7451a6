#include "linalg/selected_inverse.h"

#include <cholmod.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <memory>
#include <new>

#include "base/blas.h"
#include "linalg/cholmod_view.h"
#include "linalg/counts.h"

namespace hapsim {
namespace {

using ColumnStride = Eigen::OuterStride<>;
using FactorBlock = Eigen::Map<Eigen::MatrixXd, 0, ColumnStride>;
using ConstFactorBlock = Eigen::Map<const Eigen::MatrixXd, 0, ColumnStride>;

// L as CHOLMOD keeps it: supernodes of columns that share their rows.
struct Supernodes {
  explicit Supernodes(const cholmod_factor& f)
      : n(static_cast<int>(f.n)),
        count(static_cast<int>(f.nsuper)),
        first(static_cast<const int*>(f.super)),
        rows_at(static_cast<const int*>(f.pi)),
        values_at(static_cast<const int*>(f.px)),
        row(static_cast<const int*>(f.s)),
        of_column(f.n) {
    for (int s = 0; s < count; ++s)
      std::fill(of_column.begin() + first[s], of_column.begin() + first[s + 1], s);
  }
  int rows(int s) const { return rows_at[s + 1] - rows_at[s]; }
  int columns(int s) const { return first[s + 1] - first[s]; }
  // Where in the supernode's rows each row stands; of rows that are not in it, anything.
  void place_rows(int s, std::vector<int>& at) const {
    for (int k = 0; k < rows(s); ++k) at[row[rows_at[s] + k]] = k;
  }
  std::size_t entry(int s, int at, int column) const {
    return static_cast<std::size_t>(values_at[s]) +
           static_cast<std::size_t>(column - first[s]) * static_cast<std::size_t>(rows(s)) +
           static_cast<std::size_t>(at);
  }
  int n, count;
  const int *first, *rows_at, *values_at, *row;
  std::vector<int> of_column;
};

std::vector<double> selected(const Supernodes& S, const double* L, std::size_t size) {
  std::vector<double> Z(size, 0);
  std::vector<int> at(static_cast<std::size_t>(S.n), 0);
  for (int s = S.count - 1; s >= 0; --s) {
    const int columns = S.columns(s), rows = S.rows(s), below = rows - columns;
    const int* I = S.row + S.rows_at[s] + columns;
    const ConstFactorBlock L_s(L + S.values_at[s], rows, columns, ColumnStride(rows));
    FactorBlock Z_s(Z.data() + S.values_at[s], rows, columns, ColumnStride(rows));
    const Eigen::MatrixXd L_JJ = L_s.topRows(columns);
    const Eigen::MatrixXd inverse =
        L_JJ.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(columns, columns));
    Z_s.topRows(columns).noalias() = inverse.transpose() * inverse;
    if (below == 0) continue;
    // Z_II stands in the supernodes of its columns, all of them later.
    Eigen::MatrixXd Z_II(below, below);
    for (int c = 0; c < below;) {
      const int t = S.of_column[I[c]];
      S.place_rows(t, at);
      for (; c < below && S.of_column[I[c]] == t; ++c)
        for (int r = c; r < below; ++r) Z_II(r, c) = Z_II(c, r) = Z[S.entry(t, at[I[r]], I[c])];
    }
    const Eigen::MatrixXd Y = L_s.bottomRows(below) * inverse;
    Z_s.bottomRows(below).noalias() = -(Z_II * Y);
    Z_s.topRows(columns).noalias() -= Y.transpose() * Z_s.bottomRows(below);
  }
  return Z;
}

}  // namespace

Eigen::VectorXd inverse_on_pattern(const SymmetricSparse& matrix, const std::vector<int>& order) {
  prepare_blas_for_many_threads();
  cholmod_common common{};
  cholmod_start(&common);
  const std::unique_ptr<cholmod_common, void (*)(cholmod_common*)> finish(
      &common, [](cholmod_common* c) { cholmod_finish(c); });
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = 1;
  common.error_handler = [](int, const char*, int, const char*) {};  // status is checked instead
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  cholmod_sparse a = cholmod_view(matrix);
  std::vector<int> permutation = order;
  const auto free_factor = [&](cholmod_factor* f) { cholmod_free_factor(&f, &common); };
  const std::unique_ptr<cholmod_factor, decltype(free_factor)> factor(
      cholmod_analyze_p(&a, permutation.data(), nullptr, 0, &common), free_factor);
  ++solver_counts.analyses;
  if (factor) cholmod_factorize(&a, factor.get(), &common);
  ++solver_counts.factorisations;
  if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (!factor || common.status != CHOLMOD_OK || factor->minor != factor->n) return {};
  const Supernodes S(*factor);
  const std::vector<double> Z = selected(S, static_cast<const double*>(factor->x), factor->xsize);
  const auto* found = static_cast<const int*>(factor->Perm);
  std::vector<int> place(order.size()), at(order.size(), 0);
  for (int k = 0; k < S.n; ++k) place[found[k]] = k;
  // Entries by the supernode of their column in the factor's order.
  std::vector<std::vector<std::array<int, 3>>> asked(static_cast<std::size_t>(S.count));
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[c]; k < matrix.column_start[c + 1]; ++k) {
      const auto [column, row] = std::minmax(place[c], place[matrix.row[k]]);
      asked[S.of_column[column]].push_back({k, row, column});
    }
  Eigen::VectorXd result(static_cast<Eigen::Index>(matrix.row.size()));
  for (int s = 0; s < S.count; ++s) {
    S.place_rows(s, at);
    for (const auto& [k, row, column] : asked[s]) result[k] = Z[S.entry(s, at[row], column)];
  }
  return result;
}

}  // namespace hapsim
