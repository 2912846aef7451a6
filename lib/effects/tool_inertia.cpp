// The mass of the tool, which the sensor feels when the tool is accelerated.
#include "effects/effect_step.h"
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

// Remembers two displacements, the time between them, and how many there were of this press.
class ToolInertiaStep : public EffectStep {
 public:
  explicit ToolInertiaStep(double m) : m_(m) {}
  std::size_t memory() const override { return 8; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    Eigen::Map<Vec3> before_last(memory), last(memory + 3);
    double &dt = memory[6], &known = memory[7];
    if (sample.first) known = 0;
    if (known >= 2) {
      const Curvature c(dt, sample.dt);
      f -= m_ * (c.first * before_last + c.second * last + c.third * sample.u);
    }
    before_last = last;
    last = sample.u;
    dt = sample.dt;
    known += 1;
  }

 private:
  double m_;
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
            "the two before it; 0 in the first two of a press",
        .source = "Newton's second law for what hangs between the sensor and the body",
        .assumptions =
            "a rigid tool that does not turn, the same mass along each axis; sampled some ten "
            "times "
            "while the speed changes, for the derivative is one sample late; displacements whose "
            "noise times m / dt^2 is small beside the force's",
        .parameters = {{"m", "kg", "mass of the tool", 0, 0.05, 0, 100, 0.05, false}},
        .needs_time = true,
        .screened = true,
        .signature = "spikes where the speed changes, in the air as well",
        .confounders = {"damper", "sensor-lag", "filter", "drag"},
        .separated_by = "the same motion in the air, or the tool's mass from a scale"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& m = find_value(values, "m");
    if (press.t.empty()) return;
    for (std::size_t i = 2; i < press.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const Curvature c(press.t[i - 1] - press.t[i - 2], press.t[i] - press.t[i - 1]);
      const Vec3 a = c.first * press.u[i - 2] + c.second * press.u[i - 1] + c.third * press.u[i];
      signal.f.segment<3>(row) -= m.value * a;
      if (signal.df.cols() == 0) continue;
      if (m.column >= 0) signal.df.block<3, 1>(row, m.column) -= a;
      if (press.du.cols() == 0) continue;
      signal.df.middleRows(row, 3) -= m.value * (c.first * press.du.middleRows(row - 6, 3) +
                                                 c.second * press.du.middleRows(row - 3, 3) +
                                                 c.third * press.du.middleRows(row, 3));
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<ToolInertiaStep>(find_value(values, "m").value);
  }
};

}  // namespace

const Effect& tool_inertia_effect() {
  static const ToolInertia effect;
  return effect;
}

}  // namespace hapsim
