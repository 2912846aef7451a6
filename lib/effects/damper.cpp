// A force proportional to the rate of indentation.
#include <algorithm>
#include <limits>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// Remembers the last sample: force, displacement, whether it was in the air.
class DamperStep : public EffectStep {
 public:
  DamperStep(double c, double tau) : c_(c), tau_(tau) {}
  std::size_t memory() const override { return 7; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    Eigen::Map<Vec3> f_before(memory), u_before(memory + 3);
    double& was_in_air = memory[6];
    const Vec3 f_now = f;
    if (!sample.first && sample.dt > 0 && !sample.in_air && was_in_air == 0)
      f += tau_ * (f_now - f_before) / sample.dt - c_ * (sample.u - u_before) / sample.dt;
    f_before = f_now;
    u_before = sample.u;
    was_in_air = sample.in_air ? 1 : 0;
  }

 private:
  double c_, tau_;
};

class Damper : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "damper",
        .stage = Stage::kBody,
        .title = "a force proportional to the speed of pressing",
        .equation = "f = f_before + tau df_before/dt - c du/dt, d/dt backward over one sample",
        .source = "Kelvin-Voigt body and dashpot; thesis 3.1.3",
        .assumptions =
            "the body's viscosity is as its stiffness (tau); the dashpot at the tool is the same "
            "in every direction and at every position (c)",
        .parameters = {{"c", "N s/m", "damping at the tool", 0, 1, 0, 1e6, 1, false},
                       {"tau", "s", "retardation time of the body: viscosity over modulus", 0, 0, 0,
                        1e3, 1e-3, false, std::numeric_limits<double>::quiet_NaN(), false, true}},
        .needs_time = true,
        .one_tool = true,
        .signature =
            "too soft while the tool moves in, too stiff while it moves out, right at rest",
        .confounders = {"viscoelastic", "sensor-lag"},
        .separated_by = "presses at three rates, and a hold after the fastest",
        .kinds = {"rate", "history"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.t.empty()) return;
    const ParameterValue& c = find_value(values, "c");
    const ParameterValue& tau = find_value(values, "tau");
    const Eigen::VectorXd f = signal.f;
    const Eigen::MatrixXd df = signal.df;
    for (std::size_t i = 1; i < press.size(); ++i) {
      const double dt = press.t[i] - press.t[i - 1];
      if (dt <= 0 || press.in_air[i] || press.in_air[i - 1]) continue;
      const Eigen::Vector3d rate = (press.u[i] - press.u[i - 1]) / dt;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const Eigen::Vector3d growth = (f.segment<3>(row) - f.segment<3>(row - 3)) / dt;
      signal.f.segment<3>(row) += tau.value * growth - c.value * rate;
      if (signal.df.cols() > 0)
        signal.df.middleRows(row, 3) +=
            tau.value / dt * (df.middleRows(row, 3) - df.middleRows(row - 3, 3));
      if (tau.column >= 0) signal.df.block<3, 1>(row, tau.column) += growth;
      if (c.column >= 0) signal.df.block<3, 1>(row, c.column) -= rate;
      if (press.du.cols() > 0 && signal.df.cols() > 0)
        signal.df.middleRows(row, 3) -=
            c.value / dt * (press.du.middleRows(row, 3) - press.du.middleRows(row - 3, 3));
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<DamperStep>(find_value(values, "c").value,
                                        find_value(values, "tau").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double time = 0.05 * std::max(data.press_duration, 1e-3);
    return {{data.peak_stiffness * time, 0}, {0, 0.1 * time}};
  }
};

}  // namespace

const Effect& damper_effect() {
  static const Damper effect;
  return effect;
}

}  // namespace hapsim
