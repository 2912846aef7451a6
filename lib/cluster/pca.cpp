#include "cluster/pca.h"

#include <Eigen/Eigenvalues>

namespace hapsim {

PrincipalComponents principal_components(const Eigen::MatrixXd& samples) {
  PrincipalComponents result;
  result.mean = samples.colwise().mean();
  const Eigen::MatrixXd centred = samples.rowwise() - result.mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      centred.transpose() * centred / static_cast<double>(samples.rows() - 1));
  result.axes = solver.eigenvectors().rowwise().reverse();
  result.variance = solver.eigenvalues().reverse();
  for (Eigen::Index c = 0; c < result.axes.cols(); ++c) {
    Eigen::Index largest = 0;
    result.axes.col(c).cwiseAbs().maxCoeff(&largest);
    if (result.axes(largest, c) < 0) result.axes.col(c) *= -1;
  }
  return result;
}

Eigen::MatrixXd project(const PrincipalComponents& components, const Eigen::MatrixXd& samples,
                        Eigen::Index count) {
  return (samples.rowwise() - components.mean.transpose()) * components.axes.leftCols(count);
}

Eigen::MatrixXd project_errors(const PrincipalComponents& components, const Eigen::MatrixXd& errors,
                               Eigen::Index count) {
  const Eigen::MatrixXd squares = components.axes.leftCols(count).array().square();
  return (errors.array().square().matrix() * squares).array().sqrt();
}

}  // namespace hapsim
