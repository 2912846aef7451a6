#include "solid/node_system.h"

#include <algorithm>
#include <cassert>

namespace hapsim {

void Cliques::add(const std::vector<int>& nodes) {
  node.insert(node.end(), nodes.begin(), nodes.end());
  start.push_back(static_cast<int>(node.size()));
}

NodeSystem::NodeSystem(std::vector<char> free, Cliques cliques)
    : cliques_(std::move(cliques)), block_(free.size(), -1) {
  // A node that nothing holds together with others has no stiffness.
  std::vector<char> used(free.size(), 0);
  for (const int n : cliques_.node) used[static_cast<std::size_t>(n)] = 1;
  int blocks = 0;
  for (std::size_t n = 0; n < free.size(); ++n)
    if (free[n] && used[n]) block_[n] = blocks++;
  matrix_.size = 3 * blocks;
  build_pattern();
}

void NodeSystem::build_pattern() {
  const std::size_t blocks = static_cast<std::size_t>(matrix_.size / 3);
  // The cliques of each block, and from them the rows of blocks at and below the diagonal: a row
  // is new to a column when its mark is not that column's.
  std::vector<int> first(blocks + 1, 0);
  for (const int n : cliques_.node)
    if (const int b = block_[static_cast<std::size_t>(n)]; b >= 0) ++first[b + 1];
  for (std::size_t b = 0; b < blocks; ++b) first[b + 1] += first[b];
  std::vector<int> member(static_cast<std::size_t>(first[blocks]));
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t q = 0; q < cliques_.size(); ++q)
    for (int a = 0; a < cliques_.count(q); ++a)
      if (const int b = block_[cliques_.nodes(q)[a]]; b >= 0)
        member[next[b]++] = static_cast<int>(q);
  std::vector<int> below_start(1, 0), below, mark(blocks, -1);
  below.reserve(8 * blocks);
  for (std::size_t c = 0; c < blocks; ++c) {
    const int column = static_cast<int>(c);
    for (int k = first[c]; k < first[c + 1]; ++k) {
      const std::size_t q = static_cast<std::size_t>(member[k]);
      for (int a = 0; a < cliques_.count(q); ++a)
        if (const int r = block_[cliques_.nodes(q)[a]]; r >= column && mark[r] != column) {
          mark[r] = column;
          below.push_back(r);
        }
    }
    std::sort(below.begin() + below_start.back(), below.end());
    below_start.push_back(static_cast<int>(below.size()));
  }
  matrix_.column_start.assign(1, 0);
  matrix_.column_start.reserve(3 * blocks + 1);
  matrix_.row.reserve(9 * below.size());
  for (std::size_t c = 0; c < blocks; ++c)
    for (int k = 0; k < 3; ++k) {
      for (int i = below_start[c]; i < below_start[c + 1]; ++i)
        for (int l = (below[i] == static_cast<int>(c) ? k : 0); l < 3; ++l)
          matrix_.row.push_back(3 * below[i] + l);
      matrix_.column_start.push_back(static_cast<int>(matrix_.row.size()));
    }
  matrix_.value.assign(matrix_.row.size(), 0);

  for (std::size_t q = 0; q < cliques_.size(); ++q) {
    place_start_.push_back(place_.size());
    for (int a = 0; a < cliques_.count(q); ++a)
      for (int b = a; b < cliques_.count(q); ++b) {
        const auto [column, row] =
            std::minmax(block_[cliques_.nodes(q)[a]], block_[cliques_.nodes(q)[b]]);
        if (column < 0) {
          place_.push_back(-1);
          continue;
        }
        const auto rows = below.begin() + below_start[column];
        place_.push_back(static_cast<int>(
            std::lower_bound(rows, below.begin() + below_start[column + 1], row) - rows));
      }
  }
}

std::size_t NodeSystem::held_bytes() const {
  using hapsim::held_bytes;
  return held_bytes(cliques_) + held_bytes(block_) + held_bytes(matrix_) + held_bytes(place_) +
         held_bytes(place_start_) + held_bytes(ends_) + held_bytes(solver_);
}

void NodeSystem::clear() {
  if (matrix_.size > 0 && matrix_.row.empty()) build_pattern();
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
}

void NodeSystem::add(std::size_t clique, const Eigen::Ref<const Eigen::MatrixXd>& dense) {
  const int count = cliques_.count(clique);
  const int* nodes = cliques_.nodes(clique);
  const int* place = place_.data() + place_start_[clique];
  for (int a = 0; a < count; ++a)
    for (int b = a; b < count; ++b) {
      const int at = *place++;
      if (at < 0) continue;
      const int block_a = block_[nodes[a]], block_b = block_[nodes[b]];
      const int row = block_a < block_b ? b : a, column = block_a < block_b ? a : b;
      const int first = 3 * std::min(block_a, block_b);
      for (int j = 0; j < 3; ++j) {
        // The first block of a column is the diagonal's lower triangle, 3 - j high.
        const int skip = at == 0 ? j : 0;
        double* value =
            matrix_.value.data() + matrix_.column_start[first + j] + (at == 0 ? 0 : 3 * at - j);
        for (int i = skip; i < 3; ++i) value[i - skip] += dense(3 * row + i, 3 * column + j);
      }
    }
}

void NodeSystem::lie_between(const std::vector<std::array<int, 2>>& ends) {
  ends_.resize(static_cast<std::size_t>(matrix_.size / 3));
  for (std::size_t n = 0; n < block_.size(); ++n)
    if (block_[n] >= 0) ends_[block_[n]] = {block_[ends[n][0]], block_[ends[n][1]]};
}

bool NodeSystem::factorise() {
  if (matrix_.size == 0) return true;
  if (!solver_) solver_ = std::make_unique<StiffnessSolver>(matrix_, kind_, std::move(order_));
  if (kind_ == SolverKind::kDirect) return solver_->factorise(matrix_);
  place_ = {};
  place_start_ = {};
  const int size = matrix_.size;
  const bool done = solver_->factorise(std::move(matrix_), ends_);
  matrix_ = {.size = size, .column_start = {}, .row = {}, .value = {}};
  return done;
}

Eigen::MatrixXd NodeSystem::solve(const Eigen::MatrixXd& load) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(load.rows(), load.cols());
  if (matrix_.size == 0) return result;
  assert(solver_ && load.rows() == 3 * static_cast<Eigen::Index>(block_.size()));
  Eigen::MatrixXd compact(matrix_.size, load.cols());
  for (std::size_t n = 0; n < block_.size(); ++n)
    if (block_[n] >= 0)
      compact.middleRows(3 * block_[n], 3) = load.middleRows(3 * static_cast<Eigen::Index>(n), 3);
  compact = solver_->solve(compact);
  for (std::size_t n = 0; n < block_.size(); ++n)
    if (block_[n] >= 0)
      result.middleRows(3 * static_cast<Eigen::Index>(n), 3) = compact.middleRows(3 * block_[n], 3);
  return result;
}

}  // namespace hapsim
