#include "effects/turn.h"

#include <Eigen/Geometry>
#include <cmath>

namespace hapsim {
namespace {

Eigen::Matrix3d cross(const Vec3& w) {
  Eigen::Matrix3d c;
  c << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return c;
}

}  // namespace

std::vector<ParameterCard> Turn::parameters() {
  return {{"rx", "rad", "rotation about x", 0, 0, -1, 1, 0.02, false},
          {"ry", "rad", "rotation about y", 0, 0, -1, 1, 0.02, false},
          {"rz", "rad", "rotation about z", 0, 0, -1, 1, 0.02, false}};
}

Turn::Turn(const Values& values, const EffectCard& card) {
  Vec3 w;
  for (int k = 0; k < 3; ++k) {
    const ParameterValue& r = find_value(values, card.parameters[static_cast<std::size_t>(k)].name);
    w[k] = r.value;
    column_[k] = r.column;
  }
  const double angle = w.norm(), a2 = angle * angle;
  const Eigen::Matrix3d W = cross(w), one = Eigen::Matrix3d::Identity();
  if (angle < 1e-4) {
    R_ = one + W + 0.5 * W * W;
    J_ = one - 0.5 * W + W * W / 6;
    return;
  }
  R_ = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
  J_ = one - (1 - std::cos(angle)) / a2 * W + (angle - std::sin(angle)) / (a2 * angle) * W * W;
}

void Turn::derivatives(const Vec3& v, Eigen::Ref<Eigen::MatrixXd> dv) const {
  dv = (R_ * dv).eval();
  const Eigen::Matrix3d slope = -R_ * cross(v) * J_;
  for (int k = 0; k < 3; ++k)
    if (column_[k] >= 0) dv.col(column_[k]) += slope.col(k);
}

}  // namespace hapsim
