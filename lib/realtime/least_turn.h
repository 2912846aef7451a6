// The turn that takes one direction to another and does no more.
#pragma once

#include <Eigen/Geometry>

#include "base/vec3.h"

namespace hapsim {

// Takes unit vector a to b; not for opposite ones.
inline Eigen::Matrix3d least_turn(const Vec3& a, const Vec3& b) noexcept {
  const Vec3 v = a.cross(b);
  Eigen::Matrix3d cross;
  cross << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return Eigen::Matrix3d::Identity() + cross + cross * cross / (1 + a.dot(b));
}

}  // namespace hapsim
