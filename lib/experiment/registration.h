// How far an object has moved, from where contact points lie off its scanned surface.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// x -> R x + d about the middle of the points: scan to measurement.
struct RigidMove {
  Vec3 shift = Vec3::Zero();     // [m]
  Vec3 rotation = Vec3::Zero();  // rotation vector [rad]
  double before = 0, after = 0;  // rms distance of the points from the surface [m]
  // The move explains most of distances that are more than a scan's error.
  bool significant() const;
};

Eigen::Matrix3d rotation_matrix(const Vec3& rotation);

// Point-to-plane registration (Chen and Medioni, 1992) with a prior of 5 mm and 0.05 rad, so that
// directions in which the surface slides along itself stay at zero.
RigidMove register_points(const std::vector<Vec3>& points, const Surface& surface);

// Where a recorded point lies on the scanned object.
Vec3 moved_back(const Vec3& point, const Vec3& middle, const Vec3& shift, const Vec3& rotation);
Vec3 middle_of(const std::vector<Vec3>& points);

}  // namespace hapsim
