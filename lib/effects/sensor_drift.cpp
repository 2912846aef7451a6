// An offset of the force sensor that grows with the time of the session.
#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class SensorDrift : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-drift",
        .stage = Stage::kSensor,
        .title = "the force sensor's offset drifts during the session",
        .equation = "f = f_true + b + r t, t from the start of the session",
        .source = "thermal drift of strain-gauge force sensors, to first order",
        .assumptions = "linear in time; t runs on from press to press",
        .parameters = {{"bx", "N", "offset along x at the start", 0, 0, -1e6, 1e6, 0.1, false},
                       {"by", "N", "offset along y at the start", 0, 0, -1e6, 1e6, 0.1, false},
                       {"bz", "N", "offset along z at the start", 0, 0, -1e6, 1e6, 0.1, false},
                       {"rx", "N/s", "drift along x", 0, 0, -1e3, 1e3, 1e-4, false},
                       {"ry", "N/s", "drift along y", 0, 0, -1e3, 1e3, 1e-4, false},
                       {"rz", "N/s", "drift along z", 0, 0, -1e3, 1e3, 1e-4, false}},
        .needs_time = true,
        .signature = "an error that grows from press to press, in the air as well",
        .confounders = {"sensor-bias", "tare", "temperature", "softening"},
        .separated_by = "samples in the air, and the first position pressed again at the end",
        .contains = {"sensor-bias"},
        .kinds = {"drift", "offset"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    for (int k = 0; k < 3; ++k) {
      const ParameterValue& b = find_value(values, card().parameters[k].name);
      const ParameterValue& r = find_value(values, card().parameters[k + 3].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        const double t = press.session.empty() ? 0 : press.session[i];
        signal.f[row] += b.value + r.value * t;
        if (signal.df.cols() == 0) continue;
        if (b.column >= 0) signal.df(row, b.column) += 1;
        if (r.column >= 0) signal.df(row, r.column) += t;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    Vec3 b, r;
    for (int k = 0; k < 3; ++k) {
      b[k] = find_value(values, card().parameters[k].name).value;
      r[k] = find_value(values, card().parameters[k + 3].name).value;
    }
    return map_step([b, r](const StepSample& sample, Vec3& f) { f += b + r * sample.session; });
  }
};

}  // namespace

const Effect& sensor_drift_effect() {
  static const SensorDrift effect;
  return effect;
}

}  // namespace hapsim
