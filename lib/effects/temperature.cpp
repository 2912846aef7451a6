// A body that is softer when it is warm.
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class Temperature : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "temperature",
        .stage = Stage::kBody,
        .title = "the stiffness changes with temperature",
        .equation = "f = f_before exp(-beta (T - T_ref)), that is E(T) = E exp(-beta (T - T_ref))",
        .source =
            "first order of ln E in the temperature, as for rubbers and gels in a small range",
        .assumptions =
            "the whole body has the recorded temperature; relaxation times do not change; T_ref "
            "is set, not fitted: the recording's metadata temp_ref, otherwise its mean",
        .parameters = {{"beta", "1/K", "relative loss of stiffness per kelvin", 0, 0, -1, 1, 0.01,
                        false},
                       {"T_ref", "degC", "temperature at which E holds", 20, 20, -300, 1000, 10,
                        false, std::numeric_limits<double>::quiet_NaN(), true}},
        .needs_temperature = true,
        .signature = "too stiff in warm presses and too soft in cold ones, at all depths",
        .confounders = {"softening", "sensor-drift", "regions"},
        .separated_by = "the same place pressed warm and cold, in changing order",
        .kinds = {"temperature"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.temperature.empty()) return;
    const ParameterValue& beta = find_value(values, "beta");
    const ParameterValue& reference = find_value(values, "T_ref");
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const double warmth = press.temperature[i] - reference.value;
      const double factor = std::exp(-beta.value * warmth);
      signal.f.segment<3>(row) *= factor;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(row, 3) *= factor;
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      if (beta.column >= 0) signal.df.block<3, 1>(row, beta.column) -= warmth * f;
      if (reference.column >= 0) signal.df.block<3, 1>(row, reference.column) += beta.value * f;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const double beta = find_value(values, "beta").value;
    const double reference = find_value(values, "T_ref").value;
    return map_step([beta, reference](const StepSample& sample, Vec3& f) {
      if (!std::isnan(sample.temperature)) f *= std::exp(-beta * (sample.temperature - reference));
    });
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0, data.temperature}};
  }
};

}  // namespace

const Effect& temperature_effect() {
  static const Temperature effect;
  return effect;
}

}  // namespace hapsim
