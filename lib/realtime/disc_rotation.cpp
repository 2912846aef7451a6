#include "realtime/disc_rotation.h"

#include <cmath>
#include <numbers>

namespace hapsim {

DiscRotation bonded_disc_rotation(double nu) noexcept {
  DiscRotation disc;
  const double e = 1 - 2 * nu, logarithm = std::log1p(2 * e);  // of 3 - 4 nu
  const double ratio = e > 1e-8 ? logarithm / e : 2 - 2 * e;
  const double epsilon = logarithm / (2 * std::numbers::pi);
  disc.rocking = 8.0 / 3 * ratio * (1 + 4 * epsilon * epsilon);
  disc.torsion = 16.0 / 3;
  disc.sway = -8 / (2 - nu) * epsilon;
  return disc;
}

Matrix6 disc_stiffness(const Eigen::Matrix3d& translation, double modulus, double nu, double radius,
                       const Vec3& normal) noexcept {
  const double Ga2 = modulus / (2 * (1 + nu)) * radius * radius;
  const DiscRotation disc = bonded_disc_rotation(nu);
  const Eigen::Matrix3d along = normal * normal.transpose();
  Eigen::Matrix3d cross;  // cross v = normal x v
  cross << 0, -normal.z(), normal.y(), normal.z(), 0, -normal.x(), -normal.y(), normal.x(), 0;
  Matrix6 K;
  K.topLeftCorner<3, 3>() = 0.5 * (translation + translation.transpose());
  K.bottomLeftCorner<3, 3>() = disc.sway * Ga2 * cross;
  K.topRightCorner<3, 3>() = K.bottomLeftCorner<3, 3>().transpose();
  K.bottomRightCorner<3, 3>() =
      Ga2 * radius * (disc.rocking * (Eigen::Matrix3d::Identity() - along) + disc.torsion * along);
  return K;
}

}  // namespace hapsim
