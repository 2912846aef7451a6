// How the direction of a displacement bears on what a force may err by.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/vec3.h"

namespace hapsim {

// Of a stiffness K known up to an error D of its logarithm, K' = R exp(D) R with R = K^(1/2) and
// one variance s^2 in every component of D (D_ij + D_ji counted as one of variance 2 s^2), the
// force's mean square relative error is E|R D R u|^2 / |K u|^2 = s^2 / 2 (u.Ku tr K / |K u|^2 + 1):
// 2 s^2 where all directions are alike, and more along the soft ones of a limb, where a small turn
// of the stiff ones adds a force of their size. This is the root of its share of 2 s^2.
inline double direction_doubt(const Eigen::Matrix3d& K, const Vec3& u) noexcept {
  const Vec3 f = K * u;
  const double square = f.squaredNorm();
  return square > 0 ? std::sqrt((u.dot(f) * K.trace() / square + 1) / 4) : 1;
}

// The root of its mean square over the thirteen axes of a cube; 1 where it is hardly more, as
// beside a half-space, so that places are sampled there as if all directions were alike.
inline double mean_direction_doubt(const Eigen::Matrix3d& K) noexcept {
  constexpr double kHardlyMore = 1.05;
  double sum = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const double doubt = direction_doubt(K, Vec3(x, y, z));
        sum += doubt * doubt;
      }
  const double mean = std::sqrt(sum / 26);
  return mean > kHardlyMore ? mean : 1;
}

}  // namespace hapsim
