// A rotation that the three first parameters of an effect say as a rotation vector [rad], and what
// it does to vectors and their derivatives.
#pragma once

#include "effects/effect.h"

namespace hapsim {

class Turn {
 public:
  static std::vector<ParameterCard> parameters();
  Turn(const Values& values, const EffectCard& card);
  const Eigen::Matrix3d& R() const { return R_; }

  // Derivatives of v, a row an axis, become those of R v: R dv - R [v]x J(r) dr, J the right
  // Jacobian of the exponential map (Chirikjian, Stochastic Models, Information Theory and Lie
  // Groups, vol. 2, 10.86).
  void derivatives(const Vec3& v, Eigen::Ref<Eigen::MatrixXd> dv) const;

 private:
  Eigen::Matrix3d R_, J_;
  int column_[3];
};

}  // namespace hapsim
