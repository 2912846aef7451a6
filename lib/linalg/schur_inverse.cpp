#include "linalg/schur_inverse.h"

#include <cholmod.h>

#include <algorithm>
#include <cassert>
#include <new>

#include "base/blas.h"
#include "base/error.h"
#include "linalg/cholmod_view.h"
#include "linalg/counts.h"
#include "linalg/metis_guard.h"
#include "linalg/schur_dense.h"

namespace hapsim {
namespace {

// The graph of the blocks that are not kept. Of one that touches kept blocks no more is said: the
// kept ones come last whatever the order.
SymmetricSparse eliminated_graph(const SymmetricSparse& pattern, const std::vector<char>& kept,
                                 int block, std::vector<int>& number) {
  SymmetricSparse graph;
  number.assign(kept.size(), -1);
  for (std::size_t b = 0; b < kept.size(); ++b)
    if (!kept[b]) number[b] = graph.size++;
  graph.column_start.push_back(0);
  for (std::size_t b = 0; b < kept.size(); ++b) {
    if (kept[b]) continue;
    const int column = static_cast<int>(b) * block;
    int last = -1;
    for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
      const int row = pattern.row[k] / block;
      if (row == last) continue;
      last = row;
      if (!kept[row]) graph.row.push_back(number[row]);
    }
    graph.column_start.push_back(static_cast<int>(graph.row.size()));
  }
  graph.value.assign(graph.row.size(), 1.0);
  return graph;
}

}  // namespace

struct SchurInverse::Impl {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  int kept = 0;
  SymmetricSparse padded;   // the matrix, with the first kept column full over the kept rows
  int first = 0;            // that column
  std::vector<int> place;   // of its own entries within it
  std::vector<int> row_of;  // of an unknown of the factor's order: row of the dense block, or -1

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.postorder = 1;
    common.error_handler = [](int, const char*, int, const char*) {};  // status is checked instead
  }
  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  void check(const void* result, const char* wrong) const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (result == nullptr) fail_numerics("", wrong, "report this mesh");
  }
  void pad(const SymmetricSparse& pattern, const std::vector<int>& dense_row);
  void fill(const SymmetricSparse& matrix);
  void order_eliminated(const SymmetricSparse& graph, std::vector<int>& order);
  void gather(Eigen::MatrixXd& dense) const;
};

void SchurInverse::Impl::order_eliminated(const SymmetricSparse& graph, std::vector<int>& order) {
  order.clear();
  if (graph.size == 0) return;
  cholmod_sparse small = cholmod_view(graph);
  common.nmethods = 2;
  common.method[0].ordering = CHOLMOD_METIS;
  common.method[1].ordering = CHOLMOD_AMD;
  cholmod_factor* found = nullptr;
  {
    const MetisGuard guard;
    found = cholmod_analyze(&small, &common);
  }
  check(found, "ordering the sparse matrix failed");
  const int* permutation = static_cast<const int*>(found->Perm);
  order.assign(permutation, permutation + graph.size);
  cholmod_free_factor(&found, &common);
}

// Kept rows that nothing eliminated links would make many thin columns of the factor. With explicit
// zeros in the first kept column they fill in at once, and the kept block is one dense supernode.
void SchurInverse::Impl::pad(const SymmetricSparse& pattern, const std::vector<int>& dense_row) {
  padded.size = pattern.size;
  first = static_cast<int>(std::find(dense_row.begin(), dense_row.end(), 0) - dense_row.begin());
  for (int c = 0; c <= pattern.size; ++c) {
    padded.column_start.push_back(static_cast<int>(padded.row.size()));
    if (c == pattern.size) break;
    const auto begin = pattern.row.begin() + pattern.column_start[c];
    const auto end = pattern.row.begin() + pattern.column_start[c + 1];
    if (c != first) {
      padded.row.insert(padded.row.end(), begin, end);
      continue;
    }
    std::vector<int> rows(begin, end);
    for (int r = c; r < pattern.size; ++r)
      if (dense_row[r] >= 0) rows.push_back(r);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (auto row = begin; row != end; ++row)
      place.push_back(
          static_cast<int>(std::lower_bound(rows.begin(), rows.end(), *row) - rows.begin()));
    padded.row.insert(padded.row.end(), rows.begin(), rows.end());
  }
  padded.value.assign(padded.row.size(), 0.0);
}

void SchurInverse::Impl::fill(const SymmetricSparse& matrix) {
  assert(matrix.size == padded.size);
  if (first == matrix.size) {
    padded.value = matrix.value;
    return;
  }
  const auto from = matrix.value.begin();
  const int begin = matrix.column_start[first], end = matrix.column_start[first + 1];
  std::copy(from, from + begin, padded.value.begin());
  for (int k = begin; k < end; ++k) padded.value[begin + place[k - begin]] = matrix.value[k];
  std::copy(from + end, matrix.value.end(), padded.value.begin() + padded.column_start[first + 1]);
}

// The kept columns of the factor reach kept rows only. A postordering may have moved them, which
// permutes the factor and changes none of its values, so each goes back to its own place. Beside
// them, joined supernodes hold explicit zeros, also above the diagonal.
void SchurInverse::Impl::gather(Eigen::MatrixXd& dense) const {
  const int* super = static_cast<const int*>(factor->super);
  const int* start = static_cast<const int*>(factor->pi);
  const int* values = static_cast<const int*>(factor->px);
  const int* rows = static_cast<const int*>(factor->s);
  const double* x = static_cast<const double*>(factor->x);
  for (std::size_t s = 0; s < factor->nsuper; ++s) {
    const int height = start[s + 1] - start[s];
    for (int c = super[s]; c < super[s + 1]; ++c) {
      const int column = row_of[c];
      if (column < 0) continue;
      const int skipped = c - super[s];
      const double* from = x + values[s] + static_cast<std::ptrdiff_t>(skipped) * height;
      for (int i = skipped; i < height; ++i)
        if (const int row = row_of[rows[start[s] + i]]; row >= column) dense(row, column) = from[i];
    }
  }
}

SchurInverse::SchurInverse(const SymmetricSparse& pattern, const std::vector<char>& kept, int block)
    : impl_(std::make_unique<Impl>()) {
  assert(pattern.size > 0 && pattern.size == block * static_cast<int>(kept.size()));
  prepare_blas_for_many_threads();
  std::vector<int> number, order, eliminated;
  impl_->order_eliminated(eliminated_graph(pattern, kept, block, number), order);
  for (std::size_t b = 0; b < kept.size(); ++b)
    if (!kept[b]) eliminated.push_back(static_cast<int>(b));
  std::vector<int> permutation;
  permutation.reserve(static_cast<std::size_t>(pattern.size));
  for (const int k : order)
    for (int i = 0; i < block; ++i) permutation.push_back(block * eliminated[k] + i);
  std::vector<int> dense_row(static_cast<std::size_t>(pattern.size), -1);
  for (std::size_t b = 0; b < kept.size(); ++b)
    for (int i = 0; kept[b] && i < block; ++i) {
      const int unknown = block * static_cast<int>(b) + i;
      permutation.push_back(unknown);
      dense_row[static_cast<std::size_t>(unknown)] = impl_->kept++;
    }

  impl_->pad(pattern, dense_row);
  cholmod_sparse full = cholmod_view(impl_->padded);
  impl_->common.nmethods = 1;
  impl_->common.method[0].ordering = CHOLMOD_GIVEN;
  impl_->factor = cholmod_analyze_p(&full, permutation.data(), nullptr, 0, &impl_->common);
  impl_->check(impl_->factor, "symbolic factorisation failed");
  ++solver_counts.analyses;
  const int* final_order = static_cast<const int*>(impl_->factor->Perm);
  impl_->row_of.resize(static_cast<std::size_t>(pattern.size));
  for (int i = 0; i < pattern.size; ++i) impl_->row_of[i] = dense_row[final_order[i]];
}

SchurInverse::~SchurInverse() = default;

bool SchurInverse::invert(const SymmetricSparse& matrix, Eigen::MatrixXd& inverse, int threads) {
  const BlasThreads scope(threads);
  impl_->fill(matrix);
  cholmod_sparse a = cholmod_view(impl_->padded);
  ++solver_counts.factorisations;
  cholmod_factorize(&a, impl_->factor, &impl_->common);
  if (impl_->common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (impl_->common.status != CHOLMOD_OK || impl_->factor->minor != impl_->factor->n) return false;
  const int n = impl_->kept;
  inverse.setZero(n, n);
  if (n == 0) return true;
  impl_->gather(inverse);
  return invert_from_cholesky(inverse);
}

Eigen::MatrixXd SchurInverse::solve(const Eigen::MatrixXd& b) const {
  return cholmod_solution(impl_->factor, b, &impl_->common);
}

Eigen::Index SchurInverse::kept() const {
  return impl_->kept;
}
double SchurInverse::factor_nonzeros() const {
  return impl_->common.lnz;
}

}  // namespace hapsim
