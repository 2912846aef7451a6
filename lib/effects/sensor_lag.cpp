// A force sensor that follows with a first-order lag.
#include <cmath>

#include "effects/effects.h"
#include "fem/memory.h"

namespace hapsim {
namespace {

class SensorLag : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-lag",
        .stage = Stage::kSensor,
        .title = "the force sensor lags behind",
        .equation =
            "f_measured = f - h, dh/dt = df/dt - h/tau: first-order low pass, exact for "
            "forces that are straight between samples",
        .source = "first-order filter; same recursion as thesis (3.54)-(3.55)",
        .assumptions = "one time constant for all axes; settled before each press",
        .parameters = {{"tau", "s", "time constant", 0, 0.02, 1e-5, 10, 0.02, true}},
        .needs_time = true,
        .signature = "too soft an instant after each change of speed, right at rest",
        .confounders = {"damper", "viscoelastic"},
        .separated_by = "a fast press where the stiffness differs"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.t.empty()) return;
    const ParameterValue& tau = find_value(values, "tau");
    if (tau.value <= 0) return;
    const Eigen::VectorXd f = signal.f;
    const Eigen::MatrixXd df = signal.df;
    Eigen::Vector3d h = Eigen::Vector3d::Zero(), dh_dtau = h;
    Eigen::MatrixXd dh = Eigen::MatrixXd::Zero(3, df.cols());
    for (Eigen::Index i = 1; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const MemoryStep s = memory_step(press.t[i] - press.t[i - 1], tau.value);
      const Eigen::Vector3d change = f.segment<3>(3 * i) - f.segment<3>(3 * i - 3);
      dh_dtau = s.a * dh_dtau + s.da_dtau * h + s.dc_dtau * change;
      h = s.a * h + s.c * change;
      signal.f.segment<3>(3 * i) -= h;
      if (df.cols() == 0) continue;
      dh = s.a * dh + s.c * (df.middleRows(3 * i, 3) - df.middleRows(3 * i - 3, 3));
      signal.df.middleRows(3 * i, 3) -= dh;
      if (tau.column >= 0) signal.df.block<3, 1>(3 * i, tau.column) -= dh_dtau;
    }
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double step = std::max(data.sample_step, 1e-3);
    return {{step}, {5 * step}};
  }
};

}  // namespace

const Effect& sensor_lag_effect() {
  static const SensorLag effect;
  return effect;
}

}  // namespace hapsim
