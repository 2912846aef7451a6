#include "linalg/midpoint_grid.h"

#include <algorithm>
#include <utility>

#include "linalg/block_sparse.h"

namespace hapsim {
namespace {

constexpr double kCoarseResidual = 0.1;  // less costs more than it saves, more takes more steps
constexpr int kCoarseSteps = 300;

// The block of column c that stands at k of the pattern of blocks.
Eigen::Matrix3d block_at(const SymmetricSparse& matrix, const LowerPattern& pattern, int c, int k) {
  const bool diagonal = k == pattern.start[c];
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    // The first block of a column is the diagonal's lower triangle, 3 - j high.
    const double* value = matrix.value.data() + matrix.column_start[3 * c + j] +
                          (diagonal ? 0 : 3 * (k - pattern.start[c]) - j);
    for (int i = diagonal ? j : 0; i < 3; ++i) m(i, j) = *value++;
  }
  if (diagonal) m = Eigen::Matrix3d(m.selfadjointView<Eigen::Lower>());
  return m;
}

SymmetricSparse by_unknowns(const LowerPattern& pattern, const std::vector<double>& value) {
  SymmetricSparse a;
  a.size = 3 * pattern.size();
  a.column_start.push_back(0);
  for (int c = 0; c < pattern.size(); ++c)
    for (int j = 0; j < 3; ++j) {
      for (int k = pattern.start[c]; k < pattern.start[c + 1]; ++k)
        for (int i = pattern.row[k] == c ? j : 0; i < 3; ++i) {
          a.row.push_back(3 * pattern.row[k] + i);
          a.value.push_back(value[9 * static_cast<std::size_t>(k) + 3 * j + i]);
        }
      a.column_start.push_back(static_cast<int>(a.row.size()));
    }
  return a;
}

}  // namespace

template <class Visit>
void MidpointGrid::each_end(const std::array<int, 2>& ends, const Visit& visit) {
  if (ends[0] == ends[1]) {
    if (ends[0] >= 0) visit(ends[0], 1.0);
    return;
  }
  for (const int e : ends)
    if (e >= 0) visit(e, 0.5);
}

void MidpointGrid::assemble(const SymmetricSparse& matrix, const BlockEnds& ends,
                            const std::vector<int>& block_order) {
  const int fine = matrix.size / 3;
  std::vector<int> number(ends.size(), -1);
  for (int b = 0; b < fine; ++b)
    if (ends[b][0] == b) number[b] = blocks_++;
  const auto coarse = [&](int b) { return b < 0 ? -1 : number[b]; };
  std::vector<std::array<int, 2>> between(ends.size());
  for (int b = 0; b < fine; ++b) between[b] = {coarse(ends[b][0]), coarse(ends[b][1])};

  // Nodes that share an element do so on both grids.
  const LowerPattern pattern = block_pattern(matrix, 3);
  LowerPattern below;
  below.start.push_back(0);
  for (int c = 0; c < fine; ++c) {
    if (number[c] < 0) continue;
    for (int k = pattern.start[c]; k < pattern.start[c + 1]; ++k)
      if (const int r = number[pattern.row[k]]; r >= 0) below.row.push_back(r);
    below.start.push_back(static_cast<int>(below.row.size()));
  }
  std::vector<double> value(9 * below.row.size(), 0.0);
  const auto add = [&](int row, int column, const Eigen::Matrix3d& m) {
    if (row < column) return;
    const auto rows = below.row.begin() + below.start[column];
    const auto at = std::lower_bound(rows, below.row.begin() + below.start[column + 1], row) -
                    below.row.begin();
    Eigen::Map<Eigen::Matrix3d>(value.data() + 9 * at) += m;
  };
  for (int c = 0; c < fine; ++c)
    for (int k = pattern.start[c]; k < pattern.start[c + 1]; ++k) {
      const int r = pattern.row[k];
      const Eigen::Matrix3d m = block_at(matrix, pattern, c, k);
      each_end(between[r], [&](int row, double in_row) {
        each_end(between[c], [&](int column, double in_column) {
          add(row, column, in_row * in_column * m);
          if (r != c) add(column, row, in_row * in_column * m.transpose());
        });
      });
    }
  ends_.resize(ends.size());
  for (std::size_t b = 0; b < ends_.size(); ++b) ends_[b] = between[block_order[b]];
  matrix_ = by_unknowns(below, value);
}

bool MidpointGrid::factorise() {
  return solver_.prepare(std::exchange(matrix_, {}), 3);
}

void MidpointGrid::add_correction(const Eigen::VectorXd& scale, const std::vector<double>& r,
                                  std::vector<double>& z) const {
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(blocks_), kLanes);
  Eigen::MatrixXd x = load;
  for (std::size_t b = 0; b < ends_.size(); ++b)
    each_end(ends_[b], [&](int c, double weight) {
      for (int i = 0; i < 3; ++i) {
        const std::size_t at = 3 * b + i;
        for (int l = 0; l < kLanes; ++l)
          load(3 * c + i, l) += weight / scale[at] * r[kLanes * at + l];
      }
    });
  solver_.solve(load, x, kCoarseResidual, kCoarseSteps);
  for (std::size_t b = 0; b < ends_.size(); ++b)
    each_end(ends_[b], [&](int c, double weight) {
      for (int i = 0; i < 3; ++i) {
        const std::size_t at = 3 * b + i;
        for (int l = 0; l < kLanes; ++l) z[kLanes * at + l] += weight / scale[at] * x(3 * c + i, l);
      }
    });
}

}  // namespace hapsim
