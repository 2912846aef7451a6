// An offset of the force sensor that goes to a value and stays there.
#include <algorithm>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class SensorSettling : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-settling",
        .stage = Stage::kSensor,
        .title = "the force sensor's offset settles during the session",
        .equation = "f = f_true + b + c (1 - exp(-t/tau)), t from the start of the session",
        .source = "a strain-gauge sensor that warms up after it was switched on: one thermal mass",
        .assumptions =
            "one time constant for all axes; t runs on from press to press; one that is much "
            "longer "
            "than the session is a drift (sensor-drift), and this one has a number more than it",
        .parameters = {{"cx", "N", "how much it changes along x", 0, 0, -1e6, 1e6, 0.1, false},
                       {"cy", "N", "how much it changes along y", 0, 0, -1e6, 1e6, 0.1, false},
                       {"cz", "N", "how much it changes along z", 0, 0, -1e6, 1e6, 0.1, false},
                       {"tau", "s", "time constant", 300, 300, 1e-2, 1e6, 100, true},
                       {"bx", "N", "offset along x at the start", 0, 0, -1e6, 1e6, 0.1, false},
                       {"by", "N", "offset along y at the start", 0, 0, -1e6, 1e6, 0.1, false},
                       {"bz", "N", "offset along z at the start", 0, 0, -1e6, 1e6, 0.1, false}},
        .needs_time = true,
        .needs_session = true,
        .among_presses = true,
        .screened = true,
        .signature =
            "an error that changes fast in the first presses and then no more, in the air "
            "as well",
        .confounders = {"sensor-bias", "tare", "temperature", "softening"},
        .separated_by =
            "samples in the air between all presses, and the first position pressed "
            "again in the middle and at the end",
        .contains = {"sensor-bias", "sensor-drift"},
        .kinds = {"drift", "offset"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& tau = find_value(values, "tau");
    for (int k = 0; k < 3; ++k) {
      const ParameterValue& c = find_value(values, card().parameters[k].name);
      const ParameterValue& b = find_value(values, card().parameters[k + 4].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        const double t = press.session.empty() ? 0 : press.session[i] / tau.value;
        const double gone = -std::expm1(-t);
        signal.f[row] += b.value + c.value * gone;
        if (signal.df.cols() == 0) continue;
        if (b.column >= 0) signal.df(row, b.column) += 1;
        if (c.column >= 0) signal.df(row, c.column) += gone;
        if (tau.column >= 0) signal.df(row, tau.column) -= c.value * std::exp(-t) * t / tau.value;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    Vec3 b, c;
    for (int k = 0; k < 3; ++k) {
      c[k] = find_value(values, card().parameters[k].name).value;
      b[k] = find_value(values, card().parameters[k + 4].name).value;
    }
    return map_step(
        [b, c, tau = find_value(values, "tau").value](const StepSample& sample, Vec3& f) {
          f -= c * std::expm1(-sample.session / tau) - b;
        });
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double session = std::max(data.session, 1.0);
    return {{0, 0, 0, 0.2 * session, 0, 0, 0}, {0, 0, 0, 0.03 * session, 0, 0, 0}};
  }
  // What is over before the second press is an offset of the first, of which no other press tells;
  // what takes many sessions is a drift.
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    constexpr double kFewest = 10;
    auto limits = Effect::limits(data);
    if (data.session > 0)
      limits[3] = {data.session / std::max(kFewest, static_cast<double>(data.presses)),
                   10 * data.session};
    return limits;
  }
};

}  // namespace

const Effect& sensor_settling_effect() {
  static const SensorSettling effect;
  return effect;
}

}  // namespace hapsim
