#include "linalg/sparse_cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <cassert>
#include <new>

#include "base/blas.h"
#include "base/error.h"
#include "linalg/cholmod_view.h"
#include "linalg/counts.h"
#include "linalg/metis_guard.h"

namespace hapsim {
namespace {

SymmetricSparse block_graph(const SymmetricSparse& pattern, int block) {
  SymmetricSparse graph;
  graph.size = pattern.size / block;
  graph.column_start.push_back(0);
  for (int b = 0; b < graph.size; ++b) {
    const int column = b * block;
    int last = -1;
    for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
      const int row = pattern.row[k] / block;
      if (row != last) graph.row.push_back(last = row);
    }
    graph.column_start.push_back(static_cast<int>(graph.row.size()));
  }
  graph.value.assign(graph.row.size(), 1.0);
  return graph;
}

std::vector<int> fill_reducing_order(const SymmetricSparse& graph, cholmod_common* common) {
  cholmod_sparse small = cholmod_view(graph);
  common->nmethods = 2;
  common->method[0].ordering = CHOLMOD_METIS;
  common->method[1].ordering = CHOLMOD_AMD;
  common->postorder = 1;
  cholmod_factor* found = nullptr;
  {
    const MetisGuard guard;
    found = cholmod_analyze(&small, common);
  }
  if (common->status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (found == nullptr) fail_numerics("", "ordering the sparse matrix failed", "report this mesh");
  const int* first = static_cast<const int*>(found->Perm);
  std::vector<int> order(first, first + graph.size);
  cholmod_free_factor(&found, common);
  return order;
}

}  // namespace

struct SparseCholesky::Impl {
  cholmod_common common{};
  std::vector<int> order;
  cholmod_factor* factor = nullptr;

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.error_handler = [](int, const char*, int, const char*) {};  // status is checked instead
  }
  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  void check_memory() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  }
};

SparseCholesky::SparseCholesky(const SymmetricSparse& pattern, int block, std::vector<int> known)
    : impl_(std::make_unique<Impl>()) {
  assert(pattern.size > 0 && pattern.size % block == 0);
  prepare_blas_for_many_threads();
  cholmod_common* common = &impl_->common;
  impl_->order =
      known.empty() ? fill_reducing_order(block_graph(pattern, block), common) : std::move(known);
  assert(static_cast<int>(impl_->order.size()) * block == pattern.size);
  std::vector<int> permutation;
  permutation.reserve(static_cast<std::size_t>(pattern.size));
  for (const int at : impl_->order)
    for (int k = 0; k < block; ++k) permutation.push_back(at * block + k);

  cholmod_sparse full = cholmod_view(pattern);
  common->nmethods = 1;
  common->method[0].ordering = CHOLMOD_GIVEN;
  impl_->factor = cholmod_analyze_p(&full, permutation.data(), nullptr, 0, common);
  impl_->check_memory();
  if (impl_->factor == nullptr)
    fail_numerics("", "symbolic factorisation failed", "report this mesh");
  ++solver_counts.analyses;
}

SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::factorise(const SymmetricSparse& matrix) {
  prepare_blas_for_many_threads();  // in this thread, which may not be that of the analysis
  cholmod_sparse a = cholmod_view(matrix);
  ++solver_counts.factorisations;
  cholmod_factorize(&a, impl_->factor, &impl_->common);
  impl_->check_memory();
  return impl_->common.status == CHOLMOD_OK && impl_->factor->minor == impl_->factor->n;
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& right_hand_sides) const {
  return cholmod_solution(impl_->factor, right_hand_sides, &impl_->common);
}

std::size_t SparseCholesky::held_bytes() const {
  return sizeof(Impl) + impl_->common.memory_inuse + hapsim::held_bytes(impl_->order);
}

const std::vector<int>& SparseCholesky::order() const {
  return impl_->order;
}

double SparseCholesky::factor_nonzeros() const {
  return impl_->common.lnz;
}

}  // namespace hapsim
