// Rigid motions: frames of robots, sensors and views.
#pragma once

#include <Eigen/Geometry>

#include "base/vec3.h"

namespace hapsim {

// Maps coordinates of the inner frame to the outer one; [m].
using Pose = Eigen::Isometry3d;

// Translation and rotation by roll, pitch, yaw about the fixed axes x, y, z [rad], as in URDF:
// R = Rz(yaw) Ry(pitch) Rx(roll).
inline Pose make_pose(const Vec3& xyz, const Vec3& rpy) {
  Pose pose = Pose::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
          .toRotationMatrix();
  pose.translation() = xyz;
  return pose;
}

// A unit vector square to `direction` (which is not zero).
inline Vec3 any_square_to(const Vec3& direction) {
  int least = 0;
  direction.cwiseAbs().minCoeff(&least);
  return direction.cross(Vec3::Unit(least)).normalized();
}

}  // namespace hapsim
