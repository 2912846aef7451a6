// How the surface of a half-space moves at one place under a force at another.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec3.h"

namespace hapsim {

// Displacement at x for a unit force at y, both on a surface with outward normals there (unit), of
// a body of E = 1 (1/m): Boussinesq's and Cerruti's solutions (Johnson, Contact Mechanics, 3.2)
// in the plane of the mean normal, by the distance itself, faded out by the square of the normals'
// cosine where the surface turns away. Symmetric: of (y, x) it is the transpose. Distances below
// `least` [m] count as that.
inline Eigen::Matrix3d half_space_surface(double nu, const Vec3& x, const Vec3& x_normal,
                                          const Vec3& y, const Vec3& y_normal,
                                          double least) noexcept {
  const double cosine = x_normal.dot(y_normal);
  if (cosine <= 0) return Eigen::Matrix3d::Zero();
  const Vec3 n = (x_normal + y_normal).normalized(), way = x - y;
  Vec3 r = way - way.dot(n) * n;
  const double distance = std::max(way.norm(), least), flat = r.norm();
  if (flat > 0) r /= flat;
  // 1/(4 pi G r), G = 1 / (2 (1 + nu)).
  const double scale = cosine * cosine * (1 + nu) / (2 * std::numbers::pi * distance);
  return scale * (2 * (1 - nu) * Eigen::Matrix3d::Identity() + 2 * nu * r * r.transpose() +
                  (1 - 2 * nu) * (r * n.transpose() - n * r.transpose()));
}

}  // namespace hapsim
