// Axes of the recorded motion that are turned against those of the body.
#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/turn.h"

namespace hapsim {
namespace {

class MotionRotation : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "motion-rotation",
        .stage = Stage::kMotion,
        .title = "the recorded motion is in axes that are turned",
        .equation = "u = R u_recorded, R = exp([r]x): turned about r by |r|",
        .source =
            "rotation vector: Euler-Rodrigues formula; hand-eye calibration: Tsai and Lenz, "
            "1989",
        .assumptions =
            "the same rotation during the whole session; places and forces are not turned",
        .parameters = Turn::parameters(),
        .like_shape = true,
        .signature = "sideways forces where the motion is straight, alike at all places",
        .confounders = {"sensor-rotation", "shift", "anisotropic", "sensor-crosstalk"},
        .separated_by =
            "the tool's own motion against a gauge; presses where the surface is aslant to the "
            "axes, and sideways ones",
        .kinds = {"set-up", "direction"}};
    return card;
  }

  void move(const PressView&, const Values& values, Motion& motion) const override {
    const Turn turn(values, card());
    for (const char* name : {"rx", "ry", "rz"})
      if (find_value(values, name).column >= 0) motion.make_du();
    for (std::size_t i = 0; i < motion.u.size(); ++i) {
      if (motion.du.cols() > 0)
        turn.derivatives(motion.u[i], motion.du.middleRows(3 * static_cast<Eigen::Index>(i), 3));
      motion.u[i] = (turn.R() * motion.u[i]).eval();
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    class Turned : public EffectStep {
     public:
      explicit Turned(const Eigen::Matrix3d& R) : R_(R) {}
      void move(StepSample& sample, double*) noexcept override {
        sample.u = (R_ * sample.u).eval();
      }

     private:
      Eigen::Matrix3d R_;
    };
    return std::make_unique<Turned>(Turn(values, card()).R());
  }
};

}  // namespace

const Effect& motion_rotation_effect() {
  static const MotionRotation effect;
  return effect;
}

}  // namespace hapsim
