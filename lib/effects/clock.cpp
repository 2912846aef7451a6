// Forces that a recording has before the motion that made them.
#include <algorithm>

#include "effects/effects.h"

namespace hapsim {
namespace {

// The time between two samples in which a moment of a press lies, and where there; beyond the press
// its first or last force.
struct Between {
  Eigen::Index before = 0;
  double weight = 0;  // of the later one
  double dt = 0;      // 0: beyond the press
};

Between place_in(const std::vector<double>& t, double moment) {
  const auto last = static_cast<Eigen::Index>(t.size()) - 1;
  if (last < 1 || moment <= t.front()) return {0, 0, 0};
  if (moment >= t.back()) return {last - 1, 1, 0};
  const auto after = std::upper_bound(t.begin(), t.end(), moment);
  const double dt = *after - *(after - 1);
  return {after - t.begin() - 1, (moment - *(after - 1)) / dt, dt};
}

class Clock : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "clock",
        .stage = Stage::kSensor,
        .title = "forces and motion were recorded by clocks that are apart",
        .equation =
            "f(t) = f_true(t + e), e = e0 + r s, s the time of the session, straight between "
            "samples; before a press its first force, after it its last",
        .source = "time stamps of two devices: an offset and a rate (Mills, RFC 5905)",
        .assumptions =
            "both clocks run evenly; forces that are late by the same time in all presses are a "
            "dead time (sensor-lag), and e0 is not negative",
        .parameters = {{"e0", "s", "how early forces are recorded when the session begins", 0, 0.02,
                        0, 10, 0.02, false},
                       {"r", "1", "how much earlier by the time of the session", 0, 0, -0.1, 0.1,
                        1e-4, false}},
        .needs_time = true,
        .needs_positions = true,  // a damper of e0 times the stiffness does nearly the same at one
        .screened = true,
        .signature =
            "forces that rise before the tool moves and stand still before it does, which no "
            "material can; with a rate, more so from press to press",
        .confounders = {"damper", "sensor-lag", "touch", "viscoelastic"},
        .separated_by =
            "fast presses with a hold, at the beginning and at the end of the session; "
            "a tap on the sensor that both records show",
        .kinds = {"rate", "history"},
        .of_recording = true,
        .live = "a loop has one clock: it gives the force of the motion that has come"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue &e0 = find_value(values, "e0"), &r = find_value(values, "r");
    const bool wanted = e0.column >= 0 || r.column >= 0;
    if (press.t.size() < 2 || (e0.value == 0 && r.value == 0 && !wanted)) return;
    const Eigen::VectorXd f = signal.f;
    const Eigen::MatrixXd df = signal.df;
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Between b = place_in(press.t, press.t[i] + e0.value + r.value * press.session[i]);
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i), at = 3 * b.before;
      const double w = b.weight;
      signal.f.segment<3>(row) = (1 - w) * f.segment<3>(at) + w * f.segment<3>(at + 3);
      if (df.cols() == 0) continue;
      signal.df.middleRows(row, 3) = (1 - w) * df.middleRows(at, 3) + w * df.middleRows(at + 3, 3);
      if (b.dt == 0) continue;
      const Eigen::Vector3d rise = (f.segment<3>(at + 3) - f.segment<3>(at)) / b.dt;
      if (e0.column >= 0) signal.df.block<3, 1>(row, e0.column) += rise;
      if (r.column >= 0) signal.df.block<3, 1>(row, r.column) += press.session[i] * rise;
    }
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double step = std::max(data.sample_step, 1e-3);
    return {{1.3 * step, 0}, {4.3 * step, 0}};
  }
};

}  // namespace

const Effect& clock_effect() {
  static const Clock effect;
  return effect;
}

}  // namespace hapsim
