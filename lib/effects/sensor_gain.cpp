// Axes of the force sensor with different gains.
#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class SensorGain : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-gain",
        .stage = Stage::kSensor,
        .title = "one axis of the force sensor has a wrong gain",
        .equation = "f = (gx fx, gy fy, fz)",
        .source = "calibration matrix of a force sensor, its diagonal",
        .assumptions =
            "no crosstalk; the gain of z is 1, for a common gain looks like Young's modulus: a "
            "wrong gain g of z alone shows as gx = gy = 1/g and E times g",
        .parameters = {{"gx", "1", "gain along x over that along z", 1, 1, 0.01, 100, 0.1, false},
                       {"gy", "1", "gain along y over that along z", 1, 1, 0.01, 100, 0.1, false}},
        .like_shape = true,
        .signature = "one component of the force is wrong by a factor, in all presses",
        .confounders = {"anisotropic", "sensor-rotation", "friction"},
        .separated_by = "a calibration weight along each axis; sideways presses at turned corners",
        .kinds = {"set-up", "direction"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    for (int k = 0; k < 2; ++k) {
      const ParameterValue& g = find_value(values, card().parameters[k].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        const double f = signal.f[row];
        signal.f[row] *= g.value;
        if (signal.df.cols() == 0) continue;
        signal.df.row(row) *= g.value;
        if (g.column >= 0) signal.df(row, g.column) += f;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const double gx = find_value(values, card().parameters[0].name).value;
    const double gy = find_value(values, card().parameters[1].name).value;
    return map_step([gx, gy](const StepSample&, Vec3& f) {
      f.x() *= gx;
      f.y() *= gy;
    });
  }
};

}  // namespace

const Effect& sensor_gain_effect() {
  static const SensorGain effect;
  return effect;
}

}  // namespace hapsim
