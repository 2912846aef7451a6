#include "calibrate/pose_doubt.h"

#include <fmt/format.h>

#include <cmath>

namespace hapsim {

std::string pose_doubt(const SensorFit& fit, const StaticPoses& poses,
                       const SensorOptions& options) {
  constexpr double kTooMuch = 0.1, kMuchLess = 0.2, kMoves = 0.02;
  const auto left = [](const SensorFit& of) {
    return std::sqrt(of.residual.leftCols<3>().squaredNorm() /
                     static_cast<double>(3 * of.residual.rows()));
  };
  // Of few poses a fit leaves little in any case.
  const auto spare = fit.residual.size() - static_cast<Eigen::Index>(fit.unknowns.names.size());
  Vec3 mean = Vec3::Zero();
  for (const StaticPose& p : poses.poses) mean += p.force / static_cast<double>(poses.poses.size());
  double scatter = 0;
  for (const StaticPose& p : poses.poses) scatter += (p.force - mean).squaredNorm();
  scatter = std::sqrt(scatter / static_cast<double>(3 * poses.poses.size()));
  const double rest = left(fit);
  // A weight that never turns in the sensor is another trouble.
  if (spare < 3 || scatter < kMoves * mean.norm() || !(rest > kTooMuch * scatter)) return "";
  StaticPoses inverse = poses;
  for (StaticPose& p : inverse.poses) p.orientation.transposeInPlace();
  const double rest_inverse = left(fit_sensor(inverse, options));
  const std::string begins =
      fmt::format("the forces differ by {:.2g} N from those of any weight", rest);
  if (rest_inverse < kMuchLess * rest)
    return begins + fmt::format(
                        ", with the inverse orientations by {:.2g} N: give those of the "
                        "tool in the base",
                        rest_inverse);
  return begins +
         ": did the tool touch something, is a weight missing in the column load, are the "
         "orientations another frame's?";
}

}  // namespace hapsim
