#include "experiment/registration.h"

#include <Eigen/Dense>
#include <cmath>

#include "mesh/surface_tree.h"

namespace hapsim {

bool RigidMove::significant() const {
  constexpr double kScanError = 2.5e-4;  // [m]
  return before > kScanError && after < 0.5 * before;
}

Eigen::Matrix3d rotation_matrix(const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Vec3 middle_of(const std::vector<Vec3>& points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  return middle;
}

Vec3 moved_back(const Vec3& point, const Vec3& middle, const Vec3& shift, const Vec3& rotation) {
  return rotation_matrix(rotation).transpose() * (point - middle - shift) + middle;
}

RigidMove register_points(const std::vector<Vec3>& points, const Surface& surface) {
  constexpr double kError = 2e-4, kFar = 5e-3, kTurn = 0.05;  // [m], [m], [rad]
  const SurfaceTree tree(surface);
  const Vec3 middle = middle_of(points);
  RigidMove move;
  const auto distance = [&] {
    double sum = 0;
    for (const Vec3& p : points)
      sum += std::pow(tree.nearest(moved_back(p, middle, move.shift, move.rotation)).distance, 2);
    return std::sqrt(sum / static_cast<double>(points.size()));
  };
  move.before = distance();
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Vector6 prior;
  prior << Vec3::Constant(1 / (kFar * kFar)), Vec3::Constant(1 / (kTurn * kTurn));
  for (int round = 0; round < 30; ++round) {
    Matrix6 A = prior.asDiagonal();
    Vector6 b;
    b << move.shift, move.rotation;
    b = -prior.cwiseProduct(b);
    const Eigen::Matrix3d R = rotation_matrix(move.rotation);
    for (const Vec3& p : points) {
      const Vec3 q = moved_back(p, middle, move.shift, move.rotation);
      const SurfacePoint near = tree.nearest(q);
      const Vec3 n = R * face_normal(surface, near.face).normalized();
      const Vec3 gap = R * (q - near.point);  // measured minus scanned, in the measurement's frame
      Vector6 row;
      row << n, (p - middle - move.shift).cross(n);
      A += row * row.transpose() / (kError * kError);
      b += row * n.dot(gap) / (kError * kError);
    }
    const Vector6 step = A.ldlt().solve(b);
    move.shift += step.head<3>();
    move.rotation += step.tail<3>();
    if (step.head<3>().norm() < 1e-7 && step.tail<3>().norm() < 1e-6) break;
  }
  move.after = distance();
  return move;
}

}  // namespace hapsim
