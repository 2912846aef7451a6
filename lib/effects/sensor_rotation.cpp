// A force sensor that is mounted askew.
#include <Eigen/Geometry>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

Eigen::Matrix3d cross(const Eigen::Vector3d& w) {
  Eigen::Matrix3d c;
  c << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return c;
}

// The rotation by the vector w, and the derivatives of R f by w: -R [f]x J(w), J the right Jacobian
// of the exponential map (Chirikjian, Stochastic Models, Information Theory and Lie Groups, vol. 2,
// 10.86).
struct Turn {
  Eigen::Matrix3d R, J;
};
Turn turn_by(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d W = cross(w);
  if (angle < 1e-4)
    return {Eigen::Matrix3d::Identity() + W + 0.5 * W * W,
            Eigen::Matrix3d::Identity() - 0.5 * W + W * W / 6};
  const double a2 = angle * angle;
  return {Eigen::AngleAxisd(angle, w / angle).toRotationMatrix(),
          Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / a2 * W +
              (angle - std::sin(angle)) / (a2 * angle) * W * W};
}

class SensorRotation : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-rotation",
        .stage = Stage::kSensor,
        .title = "the force sensor is mounted askew",
        .equation = "f = R f_true, R = exp([r]x): turned about r by |r|",
        .source = "rotation vector: Euler-Rodrigues formula",
        .assumptions = "the same rotation during the whole session; displacements are not turned",
        .parameters = {{"rx", "rad", "rotation about x", 0, 0, -1, 1, 0.02, false},
                       {"ry", "rad", "rotation about y", 0, 0, -1, 1, 0.02, false},
                       {"rz", "rad", "rotation about z", 0, 0, -1, 1, 0.02, false}},
        .like_shape = true,
        .signature =
            "sideways forces in the proportion of the normal force, turned everywhere alike",
        .confounders = {"shift", "sensor-gain", "anisotropic"},
        .separated_by = "a calibration weight hung on the tool, and sideways presses both ways"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue* r[3];
    Eigen::Vector3d w;
    for (int k = 0; k < 3; ++k) {
      r[k] = &find_value(values, card().parameters[k].name);
      w[k] = r[k]->value;
    }
    const Turn turn = turn_by(w);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const Eigen::Vector3d f = signal.f.segment<3>(3 * i);
      signal.f.segment<3>(3 * i) = turn.R * f;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(3 * i, 3) = (turn.R * signal.df.middleRows(3 * i, 3)).eval();
      const Eigen::Matrix3d slope = -turn.R * cross(f) * turn.J;
      for (int k = 0; k < 3; ++k)
        if (r[k]->column >= 0) signal.df.block<3, 1>(3 * i, r[k]->column) += slope.col(k);
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    Eigen::Vector3d w;
    for (int k = 0; k < 3; ++k) w[k] = find_value(values, card().parameters[k].name).value;
    return map_step([R = turn_by(w).R](const StepSample&, Vec3& f) { f = (R * f).eval(); });
  }
};

}  // namespace

const Effect& sensor_rotation_effect() {
  static const SensorRotation effect;
  return effect;
}

}  // namespace hapsim
