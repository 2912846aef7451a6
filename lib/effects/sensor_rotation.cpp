// A force sensor that is mounted askew.
#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/turn.h"

namespace hapsim {
namespace {

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
        .parameters = Turn::parameters(),
        .like_shape = true,
        .signature =
            "sideways forces in the proportion of the normal force, turned everywhere alike",
        .confounders = {"shift", "sensor-gain", "anisotropic"},
        .separated_by = "a calibration weight hung on the tool, and sideways presses both ways",
        .kinds = {"set-up", "direction"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const Turn turn(values, card());
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const Vec3 f = signal.f.segment<3>(3 * i);
      signal.f.segment<3>(3 * i) = turn.R() * f;
      if (signal.df.cols() > 0) turn.derivatives(f, signal.df.middleRows(3 * i, 3));
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return map_step(
        [R = Turn(values, card()).R()](const StepSample&, Vec3& f) { f = (R * f).eval(); });
  }
};

}  // namespace

const Effect& sensor_rotation_effect() {
  static const SensorRotation effect;
  return effect;
}

}  // namespace hapsim
