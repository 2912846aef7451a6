#include "rig/rotation_vector.h"

#include <Eigen/Geometry>
#include <cmath>

namespace hapsim {

Eigen::Matrix3d cross_matrix(const Vec3& w) {
  Eigen::Matrix3d c;
  c << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return c;
}

Eigen::Matrix3d rotation_of(const Vec3& w) {
  const double angle = w.norm();
  if (angle < 1e-8) return Eigen::Matrix3d::Identity() + cross_matrix(w);
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Vec3 rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);  // exact where the angle is small
  const double sign = q.w() < 0 ? -1 : 1, length = q.vec().norm();
  if (length < 1e-12) return 2 * sign * q.vec();
  return sign * 2 * std::atan2(length, std::abs(q.w())) / length * q.vec();
}

Eigen::Matrix3d left_jacobian(const Vec3& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d W = cross_matrix(w);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / a2 * W +
         (angle - std::sin(angle)) / (a2 * angle) * W * W;
}

}  // namespace hapsim
