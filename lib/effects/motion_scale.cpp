// Axes of the recorded motion with different scales.
#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class MotionScale : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "motion-scale",
        .stage = Stage::kMotion,
        .title = "one axis of the recorded motion has a wrong scale",
        .equation = "u = (sx ux, sy uy, uz)",
        .source = "scale errors of a machine's axes: ISO 230-2, positioning error of an axis",
        .assumptions =
            "the same scales everywhere; that of z is 1, for a common scale looks like Young's "
            "modulus: a wrong scale s of z alone shows as sx = sy = 1/s and E times s",
        .parameters = {{"sx", "1", "true motion along x over that recorded", 1, 1, 0.1, 10, 0.1,
                        false},
                       {"sy", "1", "true motion along y over that recorded", 1, 1, 0.1, 10, 0.1,
                        false}},
        .needs_sideways = true,
        .signature = "too stiff or too soft along one axis of the recording, everywhere alike",
        .confounders = {"sensor-gain", "anisotropic", "arm-compliance"},
        .separated_by =
            "the tool's own motion against a gauge; presses where the surface is aslant to the "
            "axes, for there a wrong gain of the force is another thing",
        .kinds = {"set-up"}};
    return card;
  }

  void move(const PressView&, const Values& values, Motion& motion) const override {
    for (int k = 0; k < 2; ++k) {
      const ParameterValue& s = find_value(values, card().parameters[k].name);
      if (s.column >= 0) motion.make_du();
      for (std::size_t i = 0; i < motion.u.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        const double u = motion.u[i][k];
        motion.u[i][k] *= s.value;
        if (motion.du.cols() == 0) continue;
        motion.du.row(row) *= s.value;
        if (s.column >= 0) motion.du(row, s.column) += u;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    class Scaled : public EffectStep {
     public:
      Scaled(double sx, double sy) : sx_(sx), sy_(sy) {}
      void move(StepSample& sample, double*) noexcept override {
        sample.u.x() *= sx_;
        sample.u.y() *= sy_;
      }

     private:
      double sx_, sy_;
    };
    return std::make_unique<Scaled>(find_value(values, "sx").value, find_value(values, "sy").value);
  }
};

}  // namespace

const Effect& motion_scale_effect() {
  static const MotionScale effect;
  return effect;
}

}  // namespace hapsim
