#include "calibrate/torque_test.h"

#include <Eigen/Dense>

#include "estimate/probability.h"
#include "rig/calibration.h"

namespace hapsim {

double torque_follows_force(const SensorFit& fit, const StaticPoses& poses) {
  const auto n = static_cast<Eigen::Index>(poses.poses.size());
  const double freedom = fit.torque_freedom - static_cast<double>(kSymmetric);
  if (!fit.terms.torque || freedom < 3) return 1;
  // The symmetric matrix beside what torques alone have told.
  std::vector<Eigen::Index> own;
  for (std::size_t k = 0; k < fit.unknowns.group.size(); ++k)
    if (fit.unknowns.group[k] == kOfTorque || fit.unknowns.group[k] == kOfTorqueDrift)
      own.push_back(static_cast<Eigen::Index>(k));
  const auto width = static_cast<Eigen::Index>(own.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * n, kSymmetric + width);
  Eigen::VectorXd r(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const StaticPose& p = poses.poses[static_cast<std::size_t>(i)];
    const Wrench shown = shown_wrench(fit.state, p);
    const Vec3 w = fit.state.rotation *
                   ((fit.state.mass + p.load) * (p.orientation.transpose() * fit.state.gravity));
    for (std::size_t k = 0; k < kSymmetric; ++k) {
      const MatrixPlace& at = kSymmetricPlaces[k];
      const auto column = static_cast<Eigen::Index>(k);
      A(3 * i + at.row, column) = w[at.column];
      if (at.row != at.column) A(3 * i + at.column, column) = w[at.row];
    }
    A.block(3 * i, kSymmetric, 3, width) =
        shown.slope.bottomRows<3>() * fit.unknowns.basis(Eigen::all, own);
    r.segment<3>(3 * i) = fit.residual.row(i).tail<3>().transpose();
  }
  const Eigen::VectorXd left = r - A * A.completeOrthogonalDecomposition().solve(r);
  const double before = r.squaredNorm(), after = left.squaredNorm();
  if (!(before > 0) || !(after > 0)) return 1;
  const double f = (before - after) / kSymmetric / (after / freedom);
  return fisher_upper(f, kSymmetric, freedom);
}

}  // namespace hapsim
