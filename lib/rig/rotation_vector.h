// Rotations as vectors: the axis, as long as the angle.
#pragma once

#include <Eigen/Core>

#include "base/vec3.h"

namespace hapsim {

// [w]x, with [w]x f = w x f.
Eigen::Matrix3d cross_matrix(const Vec3& w);

// exp([w]x): Euler-Rodrigues formula; w in rad.
Eigen::Matrix3d rotation_of(const Vec3& w);

// The vector of a rotation, no longer than pi [rad].
Vec3 rotation_vector(const Eigen::Matrix3d& R);

// J with exp([w + d]x) = exp([J d]x) exp([w]x) for small d: the left Jacobian of the exponential
// map (Chirikjian, Stochastic Models, Information Theory and Lie Groups, vol. 2, 10.86).
Eigen::Matrix3d left_jacobian(const Vec3& w);

}  // namespace hapsim
