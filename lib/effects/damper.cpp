// A force proportional to the rate of indentation.
#include <algorithm>

#include "effects/effects.h"

namespace hapsim {
namespace {

class Damper : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "damper",
        .stage = Stage::kBody,
        .title = "a force proportional to the speed of pressing",
        .equation = "f = f_before - c du/dt, du/dt backward over one sample",
        .source = "Kelvin-Voigt dashpot; thesis 3.1.3",
        .assumptions = "one dashpot, the same in every direction and at every position",
        .parameters = {{"c", "N s/m", "damping", 0, 1, 0, 1e6, 1, false}},
        .needs_time = true,
        .one_tool = true,
        .signature =
            "too soft while the tool moves in, too stiff while it moves out, right at rest",
        .confounders = {"viscoelastic", "sensor-lag"},
        .separated_by = "presses at three rates, and a hold after the fastest"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.t.empty()) return;
    const ParameterValue& c = find_value(values, "c");
    for (std::size_t i = 1; i < press.size(); ++i) {
      const double dt = press.t[i] - press.t[i - 1];
      if (dt <= 0 || press.in_air[i] || press.in_air[i - 1]) continue;
      const Eigen::Vector3d rate = (press.u[i] - press.u[i - 1]) / dt;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      signal.f.segment<3>(row) -= c.value * rate;
      if (c.column >= 0) signal.df.block<3, 1>(row, c.column) -= rate;
      if (press.du.cols() > 0 && signal.df.cols() > 0)
        signal.df.middleRows(row, 3) -=
            c.value / dt * (press.du.middleRows(row, 3) - press.du.middleRows(row - 3, 3));
    }
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0.05 * data.peak_stiffness * std::max(data.press_duration, 1e-3)}};
  }
};

}  // namespace

const Effect& damper_effect() {
  static const Damper effect;
  return effect;
}

}  // namespace hapsim
