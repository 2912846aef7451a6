// A body that moves to and fro by itself.
#include <algorithm>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

Vec3 amplitude_of(const Values& values) {
  return {find_value(values, "ax").value, find_value(values, "ay").value,
          find_value(values, "az").value};
}

class BreathingStep : public EffectStep {
 public:
  BreathingStep(const Vec3& a, double f, double phase) : a_(a), f_(f), phase_(phase) {}
  void move(StepSample& sample, double*) noexcept override {
    if (!sample.in_air) sample.u -= std::sin(2 * M_PI * f_ * sample.session + phase_) * a_;
  }

 private:
  Vec3 a_;
  double f_, phase_;
};

class Breathing : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "breathing",
        .stage = Stage::kMotion,
        .title = "the body moves to and fro by itself",
        .equation =
            "u -> u - a sin(2 pi f s + phase) where the tool is in contact, s the time of the "
            "session",
        .source = "periodic motion of an organ, or of the table, to its first harmonic",
        .assumptions =
            "one line of motion, amplitude and frequency for the whole session, the same at every "
            "place; samples that are called air stay air",
        .parameters = {{"ax", "m", "amplitude along x", 0, 0, -0.05, 0.05, 1e-4, false},
                       {"ay", "m", "amplitude along y", 0, 0, -0.05, 0.05, 1e-4, false},
                       {"az", "m", "amplitude along z", 0, 1e-4, -0.05, 0.05, 1e-4, false},
                       {"f", "Hz", "frequency", 0.25, 0.25, 1e-4, 1e3, 1e-3, false},
                       {"phase", "rad", "phase when the session begins", 0, 0, -20, 20, 0.1,
                        false}},
        .needs_time = true,
        .needs_session = true,
        .needs_line = true,
        .signature =
            "a force that goes up and down at one frequency through all presses, whatever "
            "the tool does",
        .confounders = {"sensor-hum", "sensor-drift", "temperature", "viscoelastic"},
        .separated_by =
            "the tool held still on the body over ten periods; the frequency of the "
            "breath, the pump or the table measured",
        .kinds = {"frequency"}};
    return card;
  }

  void move(const PressView& press, const Values& values, Motion& motion) const override {
    const Vec3 a = amplitude_of(values);
    const ParameterValue &f = find_value(values, "f"), &phase = find_value(values, "phase");
    const bool wanted = std::any_of(values.begin(), values.end(),
                                    [](const ParameterValue& v) { return v.column >= 0; });
    if (press.session.empty() || (a.isZero() && !wanted)) return;
    if (wanted) motion.make_du();
    for (std::size_t i = 0; i < motion.u.size(); ++i) {
      if (press.in_air[i]) continue;
      const double angle = 2 * M_PI * f.value * press.session[i] + phase.value;
      const double wave = std::sin(angle);
      motion.u[i] -= wave * a;
      if (motion.du.cols() == 0) continue;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      for (int k = 0; k < 3; ++k)
        if (const int column = find_value(values, card().parameters[k].name).column; column >= 0)
          motion.du(row + k, column) -= wave;
      const Vec3 turn = std::cos(angle) * a;
      if (f.column >= 0) motion.du.block<3, 1>(row, f.column) -= 2 * M_PI * press.session[i] * turn;
      if (phase.column >= 0) motion.du.block<3, 1>(row, phase.column) -= turn;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<BreathingStep>(amplitude_of(values), find_value(values, "f").value,
                                           find_value(values, "phase").value);
  }

  // The phase is that of the strongest component.
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const SpectralLine& line = data.line;
    if (line.frequency == 0) return {{1e-4, 1e-4, 3e-4, 0.3, 0.5}};
    int k = 0;
    (line.sine.cwiseAbs2() + line.cosine.cwiseAbs2()).maxCoeff(&k);
    const double phase = std::atan2(line.cosine[k], line.sine[k]);
    const Vec3 a =
        (std::cos(phase) * line.sine + std::sin(phase) * line.cosine) / data.peak_stiffness;
    return {{a.x(), a.y(), a.z(), line.frequency, phase}};
  }
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    for (std::size_t k = 0; k < 3; ++k) limits[k] = {-data.depth, data.depth};
    const SpectralLine& line = data.line;
    if (line.frequency > 0)
      limits[3] = {std::max(0.5 * line.frequency, line.frequency - 2 * line.resolution),
                   line.frequency + 2 * line.resolution};
    return limits;
  }
};

}  // namespace

const Effect& breathing_effect() {
  static const Breathing effect;
  return effect;
}

}  // namespace hapsim
