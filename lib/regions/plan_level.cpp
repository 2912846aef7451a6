#include "regions/plan_level.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// The thin plate's kernel of the squared distance.
double plate(double squared) {
  return squared > 0 ? 0.5 * squared * std::log(squared) : 0;
}

}  // namespace

PlanLevel::PlanLevel(const std::vector<Eigen::Vector2d>& knots, int modes) {
  const auto n = static_cast<Eigen::Index>(knots.size());
  for (const Eigen::Vector2d& p : knots) middle_ += p / static_cast<double>(n);
  reach_ = 0;
  for (const Eigen::Vector2d& p : knots) reach_ = std::max(reach_, (p - middle_).norm());
  reach_ = std::max(reach_, 1e-9);
  knots_.resize(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
    knots_.row(i) = (knots[static_cast<std::size_t>(i)] - middle_).transpose() / reach_;
  Eigen::MatrixXd kernel(n, n), plane(n, kPlane);
  plane << Eigen::VectorXd::Ones(n), knots_;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      kernel(i, j) = plate((knots_.row(i) - knots_.row(j)).squaredNorm());
  // Factors that no plane has, in which the kernel is positive.
  const Eigen::MatrixXd all = plane.householderQr().householderQ();
  const Eigen::MatrixXd free = all.rightCols(n - kPlane);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(free.transpose() * kernel * free);
  const Eigen::Index count = std::min<Eigen::Index>(modes, n - kPlane);
  mode_.resize(n, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index from = n - kPlane - 1 - k;  // eigenvalues ascend: the largest bends least
    mode_.col(k) = free * eigen.eigenvectors().col(from) /
                   std::sqrt(std::max(eigen.eigenvalues()[from], 1e-12));
  }
}

Eigen::RowVectorXd PlanLevel::basis(const Eigen::Vector2d& p) const {
  const Eigen::RowVector2d q = (p - middle_).transpose() / reach_;
  Eigen::RowVectorXd kernel(knots_.rows());
  for (Eigen::Index i = 0; i < knots_.rows(); ++i)
    kernel[i] = plate((q - knots_.row(i)).squaredNorm());
  Eigen::RowVectorXd result(size());
  result << 1, q, kernel * mode_;
  return reach_ * result;
}

Eigen::MatrixXd PlanLevel::slope(const Eigen::Vector2d& p) const {
  const Eigen::RowVector2d q = (p - middle_).transpose() / reach_;
  Eigen::MatrixXd kernel(2, knots_.rows());
  for (Eigen::Index i = 0; i < knots_.rows(); ++i) {
    const Eigen::RowVector2d off = q - knots_.row(i);
    const double squared = off.squaredNorm();
    kernel.col(i) = (squared > 0 ? std::log(squared) + 1 : 0) * off.transpose();
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(2, size());
  result(0, 1) = result(1, 2) = 1;
  result.rightCols(mode_.cols()) = kernel * mode_;
  return result;
}

PlanLevel::Distance PlanLevel::distance(const Eigen::Vector2d& p,
                                        const Eigen::VectorXd& theta) const {
  constexpr double kFlat = 0.2;  // slopes below it are none of a curve
  const Eigen::RowVectorXd b = basis(p);
  const double steep = std::max(kFlat, (slope(p) * theta).norm());
  return {b.dot(theta) / steep, b / steep};
}

Eigen::VectorXd PlanLevel::fitted(const std::vector<Eigen::Vector2d>& points,
                                  const Eigen::VectorXd& values, double stiffness) const {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(points.size()), size());
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    A.row(i) = basis(points[static_cast<std::size_t>(i)]) / reach_;
  Eigen::MatrixXd H = A.transpose() * A;
  H.diagonal().tail(mode_.cols()).array() += stiffness;
  H.diagonal().array() += 1e-9;
  return H.ldlt().solve(A.transpose() * values / reach_);
}

}  // namespace hapsim
