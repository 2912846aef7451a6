// A constant offset of the force sensor.
#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class SensorBias : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-bias",
        .stage = Stage::kSensor,
        .title = "the force sensor has an offset",
        .equation = "f = f_true + b",
        .source = "zero offset of strain-gauge force sensors; thesis 6.1.3",
        .assumptions = "the same offset during the whole session",
        .parameters = {{"bx", "N", "offset along x", 0, 0, -1e6, 1e6, 0.1, false},
                       {"by", "N", "offset along y", 0, 0, -1e6, 1e6, 0.1, false},
                       {"bz", "N", "offset along z", 0, 0, -1e6, 1e6, 0.1, false}},
        .signature = "the same error at every depth and position, in the air as well",
        .confounders = {"sensor-drift", "tare", "deadband"},
        .separated_by = "samples in the air before and after contact",
        .kinds = {"offset"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    for (int k = 0; k < 3; ++k) {
      const ParameterValue& b = find_value(values, card().parameters[k].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        signal.f[row] += b.value;
        if (b.column >= 0 && signal.df.cols() > 0) signal.df(row, b.column) += 1;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    Vec3 b;
    for (int k = 0; k < 3; ++k) b[k] = find_value(values, card().parameters[k].name).value;
    return map_step([b](const StepSample&, Vec3& f) { f += b; });
  }
};

}  // namespace

const Effect& sensor_bias_effect() {
  static const SensorBias effect;
  return effect;
}

}  // namespace hapsim
