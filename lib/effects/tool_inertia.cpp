// The mass of the tool, which the sensor feels when the tool is accelerated.
#include "effects/effects.h"

namespace hapsim {
namespace {

// Weights of three displacements in the second derivative of the parabola through them, `before`
// and `after` the steps in time about the second [s].
struct Curvature {
  double first = 0, second = 0, third = 0;
  Curvature(double before, double after) {
    if (before <= 0 || after <= 0) return;
    const double whole = before + after;
    first = 2 / (before * whole), second = -2 / (before * after), third = 2 / (after * whole);
  }
};

class ToolInertia : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "tool-inertia",
        .stage = Stage::kSensor,
        .title = "the sensor feels the mass of the tool when it is accelerated",
        .equation =
            "f = f_true - m d2u/dt2, the second derivative of the parabola through a sample and "
            "its neighbours; 0 in the first and the last of a press",
        .source = "Newton's second law for what hangs between the sensor and the body",
        .assumptions =
            "a rigid tool that does not turn, the same mass along each axis; displacements whose "
            "noise times m / dt^2 is small beside the force's",
        .parameters = {{"m", "kg", "mass of the tool", 0, 0.05, 0, 100, 0.05, false}},
        .needs_time = true,
        .screened = true,
        .signature = "spikes where the speed changes, in the air as well",
        .confounders = {"damper", "sensor-lag", "filter", "drag"},
        .separated_by = "the same motion in the air, or the tool's mass from a scale",
        .kinds = {"rate", "event"},
        .of_recording = true,
        .live =
            "a second derivative asks for the sample that follows, and a hand that holds a tool "
            "feels its mass already: a live loop leaves it out"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& m = find_value(values, "m");
    if (press.t.empty()) return;
    for (std::size_t i = 1; i + 1 < press.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const Curvature c(press.t[i] - press.t[i - 1], press.t[i + 1] - press.t[i]);
      const Vec3 a = c.first * press.u[i - 1] + c.second * press.u[i] + c.third * press.u[i + 1];
      signal.f.segment<3>(row) -= m.value * a;
      if (signal.df.cols() == 0) continue;
      if (m.column >= 0) signal.df.block<3, 1>(row, m.column) -= a;
      if (press.du.cols() == 0) continue;
      signal.df.middleRows(row, 3) -= m.value * (c.first * press.du.middleRows(row - 3, 3) +
                                                 c.second * press.du.middleRows(row, 3) +
                                                 c.third * press.du.middleRows(row + 3, 3));
    }
  }
};

}  // namespace

const Effect& tool_inertia_effect() {
  static const ToolInertia effect;
  return effect;
}

}  // namespace hapsim
