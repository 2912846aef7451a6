#include "estimate/penalty_matrix.h"

#include <algorithm>

#include "base/error.h"
#include "linalg/selected_inverse.h"

namespace hapsim {

PenaltyMatrix::PenaltyMatrix(const FieldProblem& p) : problem_(p) {
  const int n = static_cast<int>(p.J.cols());
  std::vector<std::vector<int>> below(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) below[i].push_back(i);
  for (const auto& [a, b] : p.edges) below[std::min(a, b)].push_back(std::max(a, b));
  matrix_.size = n;
  matrix_.column_start.assign(1, 0);
  for (auto& rows : below) {
    std::sort(rows.begin(), rows.end());
    matrix_.row.insert(matrix_.row.end(), rows.begin(), rows.end());
    matrix_.column_start.push_back(static_cast<int>(matrix_.row.size()));
  }
  matrix_.value.assign(matrix_.row.size(), 0);
  for (const auto& [a, b] : p.edges) {
    const int column = std::min(a, b);
    const auto begin = matrix_.row.begin() + matrix_.column_start[column];
    const auto end = matrix_.row.begin() + matrix_.column_start[column + 1];
    place_.push_back(std::lower_bound(begin, end, std::max(a, b)) - matrix_.row.begin());
  }
  cholesky_ = std::make_unique<SparseCholesky>(matrix_, 1);
}

void PenaltyMatrix::set(const Eigen::VectorXd& q) {
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for (Eigen::Index i = 0; i < problem_.node_weight.size(); ++i)
    diagonal(i) += problem_.node_weight[i] * problem_.node_weight[i];
  for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
    const auto i = static_cast<Eigen::Index>(e);
    const double w = q[i] * problem_.edge_weight[i] * problem_.edge_weight[i];
    diagonal(problem_.edges[e][0]) += w;
    diagonal(problem_.edges[e][1]) += w;
    matrix_.value[static_cast<std::size_t>(place_[e])] -= w;
  }
}

Eigen::MatrixXd PenaltyMatrix::inverse_times_J(const Eigen::VectorXd& q) {
  set(q);
  if (!cholesky_->factorise(matrix_)) return {};
  return cholesky_->solve(problem_.J.transpose());
}

PenaltyMatrix::Inverse PenaltyMatrix::inverse() const {
  const Eigen::VectorXd entries = inverse_on_pattern(matrix_, cholesky_->order());
  if (entries.size() == 0)
    fail_numerics("", "the penalty of a field is not positive definite", "report this");
  Inverse result;
  result.diagonal.resize(problem_.J.cols());
  for (Eigen::Index i = 0; i < result.diagonal.size(); ++i)
    result.diagonal[i] = entries[matrix_.column_start[i]];
  result.beside.resize(static_cast<Eigen::Index>(place_.size()));
  for (std::size_t e = 0; e < place_.size(); ++e)
    result.beside[static_cast<Eigen::Index>(e)] = entries[place_[e]];
  return result;
}

}  // namespace hapsim
