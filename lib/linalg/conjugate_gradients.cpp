#include "linalg/conjugate_gradients.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hapsim {

Eigen::VectorXd multiply(const SymmetricSparse& matrix, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (int c = 0; c < matrix.size; ++c) {
    const int begin = matrix.column_start[c], end = matrix.column_start[c + 1];
    double sum = matrix.value[begin] * x[c];  // the diagonal stands first
    for (int k = begin + 1; k < end; ++k) {
      y[matrix.row[k]] += matrix.value[k] * x[c];
      sum += matrix.value[k] * x[matrix.row[k]];
    }
    y[c] += sum;
  }
  return y;
}

bool ConjugateGradients::prepare(const SymmetricSparse& matrix) {
  factor_ = matrix;
  scale_.resize(matrix.size);
  for (int c = 0; c < matrix.size; ++c) {
    const int diagonal = matrix.column_start[c];
    if (diagonal == matrix.column_start[c + 1] || matrix.row[diagonal] != c ||
        !(matrix.value[diagonal] > 0))
      return false;
    scale_[c] = 1 / std::sqrt(matrix.value[diagonal]);
  }
  scaled_ = matrix.value;
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[c]; k < matrix.column_start[c + 1]; ++k)
      scaled_[k] *= scale_[c] * scale_[matrix.row[k]];
  for (shift_ = 0; shift_ < 100; shift_ = shift_ == 0 ? 1e-3 : 2 * shift_)
    if (factorise(shift_)) return true;
  return false;
}

bool ConjugateGradients::factorise(double shift) {
  factor_.value = scaled_;
  const auto& start = factor_.column_start;
  const auto& row = factor_.row;
  auto& value = factor_.value;
  for (int c = 0; c < factor_.size; ++c) value[start[c]] += shift;
  for (int c = 0; c < factor_.size; ++c) {
    const int begin = start[c], end = start[c + 1];
    // A pivot far below one makes a factor worse than none.
    if (!(value[begin] > 1e-3)) return false;
    const double pivot = std::sqrt(value[begin]);
    value[begin] = pivot;
    for (int k = begin + 1; k < end; ++k) value[k] /= pivot;
    // Column c times its own entries, where the target column has a place for it.
    for (int k = begin + 1; k < end; ++k) {
      const double factor = value[k];
      int target = start[row[k]];
      const int target_end = start[row[k] + 1];
      for (int i = k; i < end; ++i) {
        while (target < target_end && row[target] < row[i]) ++target;
        if (target == target_end) break;
        if (row[target] == row[i]) value[target] -= factor * value[i];
      }
    }
  }
  return true;
}

Eigen::VectorXd ConjugateGradients::preconditioned(const Eigen::VectorXd& r) const {
  const auto& start = factor_.column_start;
  Eigen::VectorXd z = scale_.cwiseProduct(r);
  for (int c = 0; c < factor_.size; ++c) {
    z[c] /= factor_.value[start[c]];
    for (int k = start[c] + 1; k < start[c + 1]; ++k) z[factor_.row[k]] -= factor_.value[k] * z[c];
  }
  for (int c = factor_.size - 1; c >= 0; --c) {
    for (int k = start[c] + 1; k < start[c + 1]; ++k) z[c] -= factor_.value[k] * z[factor_.row[k]];
    z[c] /= factor_.value[start[c]];
  }
  return scale_.cwiseProduct(z);
}

IterationReport ConjugateGradients::solve(const SymmetricSparse& matrix, const Eigen::VectorXd& b,
                                          Eigen::VectorXd& x, double tolerance, int limit) const {
  assert(factor_.size == matrix.size && b.size() == matrix.size && x.size() == matrix.size);
  if (limit == 0) limit = std::max(1000, static_cast<int>(10 * std::sqrt(matrix.size)));
  IterationReport report;
  const double norm = b.norm();
  if (norm == 0) {
    x.setZero();
    report.converged = true;
    return report;
  }
  Eigen::VectorXd r = b - multiply(matrix, x), p;
  double rho = 0;
  for (report.residual = r.norm() / norm; report.iterations < limit; ++report.iterations) {
    if (report.residual <= tolerance) break;
    const Eigen::VectorXd z = preconditioned(r);
    const double next = r.dot(z);
    p = report.iterations == 0 ? z : Eigen::VectorXd(z + next / rho * p);
    rho = next;
    const Eigen::VectorXd q = multiply(matrix, p);
    const double curvature = p.dot(q);
    if (!(curvature > 0)) break;  // not positive definite
    x += rho / curvature * p;
    r -= rho / curvature * q;
    report.residual = r.norm() / norm;
  }
  // The recurrence drifts from the truth: say the true residual.
  report.residual = (b - multiply(matrix, x)).norm() / norm;
  report.converged = report.residual <= 2 * tolerance;
  return report;
}

}  // namespace hapsim
