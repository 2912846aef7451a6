// A force sensor whose reading is not proportional to the force.
#include <array>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

double bend(double second, double third, double f) {
  return second * std::abs(f) * f + third * f * f * f;
}

class SensorCurve : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-curve",
        .stage = Stage::kSensor,
        .title = "the force sensor's reading is not proportional to the force",
        .equation =
            "f = f_true + c2 |f_true| f_true + c3 f_true^3 on each axis; x and y share theirs",
        .source = "non-linearity of strain-gauge force sensors, second and third order",
        .assumptions = "odd in the force: pulling reads as pressing; no hysteresis",
        .parameters = {{"c2", "1/N", "second order, z axis", 0, 0, -10, 10, 0.02, false},
                       {"c3", "1/N^2", "third order, z axis", 0, 0, -10, 10, 0.02, false},
                       {"d2", "1/N", "second order, x and y axes", 0, 0, -10, 10, 0.02, false},
                       {"d3", "1/N^2", "third order, x and y axes", 0, 0, -10, 10, 0.02, false}},
        .most_bend = 0.05,  // the worst force sensors on sale are at 0.01
        .signature = "an error that follows the force, whatever place, depth or direction made it",
        .confounders = {"hyperelastic", "tip", "deadband"},
        .separated_by =
            "calibration weights up to the largest force; the same force at a stiff and at a soft "
            "place",
        .kinds = {"reading", "depth"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    for (int k = 0; k < 3; ++k) {
      const auto& names = card().parameters;
      const ParameterValue& second = find_value(values, names[k == 2 ? 0 : 2].name);
      const ParameterValue& third = find_value(values, names[k == 2 ? 1 : 3].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        const double f = signal.f[row], size = std::abs(f);
        signal.f[row] += bend(second.value, third.value, f);
        if (signal.df.cols() == 0) continue;
        signal.df.row(row) *= 1 + 2 * second.value * size + 3 * third.value * f * f;
        if (second.column >= 0) signal.df(row, second.column) += size * f;
        if (third.column >= 0) signal.df(row, third.column) += f * f * f;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    std::array<double, 4> c;
    for (std::size_t k = 0; k < 4; ++k) c[k] = find_value(values, card().parameters[k].name).value;
    return map_step([c](const StepSample&, Vec3& f) {
      for (int k = 0; k < 3; ++k) f[k] += k == 2 ? bend(c[0], c[1], f[k]) : bend(c[2], c[3], f[k]);
    });
  }
};

}  // namespace

const Effect& sensor_curve_effect() {
  static const SensorCurve effect;
  return effect;
}

}  // namespace hapsim
