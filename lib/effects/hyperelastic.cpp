// Stiffening with depth, condensed to the contact.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"

namespace hapsim {
namespace {

class Hyperelastic : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "hyperelastic",
        .stage = Stage::kBody,
        .title = "the material stiffens (or softens) with depth",
        .equation =
            "f = f_linear (1 + b1 q + b2 q^2), q = |u| / tool radius: the secant stiffness "
            "of finite strain, expanded in the depth and condensed to the contact",
        .source =
            "expansion of the contact energy of a strain-stiffening solid in the indentation, "
            "which scales with |u|/a by dimension (Johnson, Contact Mechanics, 4.1)",
        .assumptions =
            "no finite-strain elements: the same stiffening at every position and in "
            "every direction; trust it within the depths of the recording only",
        .parameters = {{"b1", "1", "stiffening, first order in |u|/radius", 0, 0, -2, 20, 0.3,
                        false},
                       {"b2", "1", "stiffening, second order", 0, 0, -2, 20, 0.3, false}},
        .signature = "too soft deep down and too stiff at small depth, everywhere",
        .confounders = {"tip", "sensor-curve"},
        .separated_by = "deeper presses with a flat tool, and a calibration weight on the sensor"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& b1 = find_value(values, "b1");
    const ParameterValue& b2 = find_value(values, "b2");
    for (std::size_t i = 0; i < press.size(); ++i) {
      const double q = press.u[i].norm() / press.radius;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      const double factor = 1 + b1.value * q + b2.value * q * q;
      signal.f.segment<3>(row) *= factor;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(row, 3) *= factor;
      if (b1.column >= 0) signal.df.block<3, 1>(row, b1.column) += q * f;
      if (b2.column >= 0) signal.df.block<3, 1>(row, b2.column) += q * q * f;
      if (press.du.cols() > 0 && q > 0)
        signal.df.middleRows(row, 3) += (b1.value + 2 * b2.value * q) /
                                        (press.radius * press.u[i].norm()) * f *
                                        (press.u[i].transpose() * press.du.middleRows(row, 3));
    }
  }
};

}  // namespace

const Effect& hyperelastic_effect() {
  static const Hyperelastic effect;
  return effect;
}

}  // namespace hapsim
