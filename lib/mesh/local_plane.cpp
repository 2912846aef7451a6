#include "mesh/local_plane.h"

#include <Eigen/Eigenvalues>

namespace hapsim {

LocalPlane fit_plane(const std::vector<Vec3>& points, const std::vector<double>& weights) {
  LocalPlane plane;
  double total = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double w = weights.empty() ? 1 : weights[i];
    plane.centre += w * points[i];
    total += w;
  }
  plane.centre /= total;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 d = points[i] - plane.centre;
    covariance += (weights.empty() ? 1 : weights[i]) * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance / total);
  plane.spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  plane.normal = solver.eigenvectors().col(0);
  plane.thickness = plane.spread[0];
  return plane;
}

}  // namespace hapsim
