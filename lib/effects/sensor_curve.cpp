// A force sensor whose reading is not proportional to the force.
#include <cmath>

#include "effects/effects.h"

namespace hapsim {
namespace {

class SensorCurve : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-curve",
        .stage = Stage::kSensor,
        .title = "the force sensor's reading is not proportional to the force",
        .equation =
            "f_k = f (1 + c2 |f| + c3 f^2 + e |F|) on each axis, f its true force and F the whole "
            "vector; x and y share their constants d2, d3",
        .source = "non-linearity of strain-gauge force sensors, second and third order",
        .assumptions = "odd in the force: pulling reads as pressing; no hysteresis",
        .parameters = {{"c2", "1/N", "second order, z axis", 0, 0, -10, 10, 0.02, false},
                       {"c3", "1/N^2", "third order, z axis", 0, 0, -10, 10, 0.02, false},
                       {"d2", "1/N", "second order, x and y axes", 0, 0, -10, 10, 0.02, false},
                       {"d3", "1/N^2", "third order, x and y axes", 0, 0, -10, 10, 0.02, false},
                       {"e", "1/N", "loss or gain by the size of the whole force", 0, 0, -10, 10,
                        0.02, false}},
        .signature = "an error that follows the force, whatever place, depth or direction made it",
        .confounders = {"hyperelastic", "tip", "deadband"},
        .separated_by =
            "calibration weights up to the largest force; the same force at a stiff and at a soft "
            "place"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue* second[3];
    const ParameterValue* third[3];
    for (int k = 0; k < 3; ++k) {
      second[k] = &find_value(values, k == 2 ? "c2" : "d2");
      third[k] = &find_value(values, k == 2 ? "c3" : "d3");
    }
    const ParameterValue& whole = find_value(values, "e");
    for (Eigen::Index row = 0; row < 3 * static_cast<Eigen::Index>(press.size()); row += 3) {
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      const double size = f.norm();
      Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
      if (size > 0) slope = whole.value / size * f * f.transpose();
      for (int k = 0; k < 3; ++k) {
        const double a = std::abs(f[k]), c2 = second[k]->value, c3 = third[k]->value;
        signal.f[row + k] = f[k] * (1 + c2 * a + c3 * a * a + whole.value * size);
        slope(k, k) += 1 + 2 * c2 * a + 3 * c3 * a * a + whole.value * size;
      }
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(row, 3) = (slope * signal.df.middleRows(row, 3)).eval();
      for (int k = 0; k < 3; ++k) {
        if (second[k]->column >= 0) signal.df(row + k, second[k]->column) += std::abs(f[k]) * f[k];
        if (third[k]->column >= 0) signal.df(row + k, third[k]->column) += f[k] * f[k] * f[k];
      }
      if (whole.column >= 0) signal.df.block<3, 1>(row, whole.column) += size * f;
    }
  }
};

}  // namespace

const Effect& sensor_curve_effect() {
  static const SensorCurve effect;
  return effect;
}

}  // namespace hapsim
