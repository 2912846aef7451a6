// A line in the force sensor's signal: mains, a motor, a fan.
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class SensorHum : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-hum",
        .stage = Stage::kSensor,
        .title = "the force sensor hums at one frequency",
        .equation =
            "F -> F + (sx, sy, sz) sin(2 pi f t) + (cx, cy, cz) cos(2 pi f t), t the time of the "
            "session",
        .source =
            "pick-up of mains, a motor or a fan, to its first harmonic; sampled more slowly than "
            "twice its frequency it shows at another (Shannon, Proc. IRE 37, 1949)",
        .assumptions =
            "one line, amplitude, phases and frequency for the whole session, in the air as in "
            "contact",
        .parameters = {{"sx", "N", "sine along x", 0, 0, -1e6, 1e6, 0.01, false},
                       {"sy", "N", "sine along y", 0, 0, -1e6, 1e6, 0.01, false},
                       {"sz", "N", "sine along z", 0, 0, -1e6, 1e6, 0.01, false},
                       {"cx", "N", "cosine along x", 0, 0, -1e6, 1e6, 0.01, false},
                       {"cy", "N", "cosine along y", 0, 0, -1e6, 1e6, 0.01, false},
                       {"cz", "N", "cosine along z", 0, 0, -1e6, 1e6, 0.01, false},
                       {"f", "Hz", "frequency", 0.25, 0.25, 1e-4, 1e5, 1e-3, false}},
        .needs_time = true,
        .needs_session = true,
        .needs_line = true,
        .signature =
            "a force that goes up and down at one frequency, as much in the air as in "
            "contact",
        .confounders = {"breathing", "sensor-drift"},
        .separated_by =
            "samples in the air between the presses, over ten periods; the sensor's "
            "leads and the robot's drives switched off in turn",
        .kinds = {"frequency"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.session.empty()) return;
    const ParameterValue& f = find_value(values, "f");
    for (int k = 0; k < 3; ++k) {
      const ParameterValue& s = find_value(values, card().parameters[k].name);
      const ParameterValue& c = find_value(values, card().parameters[k + 3].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        const double turn = 2 * M_PI * press.session[i], angle = turn * f.value;
        const double sine = std::sin(angle), cosine = std::cos(angle);
        signal.f[row] += s.value * sine + c.value * cosine;
        if (signal.df.cols() == 0) continue;
        if (s.column >= 0) signal.df(row, s.column) += sine;
        if (c.column >= 0) signal.df(row, c.column) += cosine;
        if (f.column >= 0) signal.df(row, f.column) += turn * (s.value * cosine - c.value * sine);
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    Vec3 s, c;
    for (int k = 0; k < 3; ++k) {
      s[k] = find_value(values, card().parameters[k].name).value;
      c[k] = find_value(values, card().parameters[k + 3].name).value;
    }
    return map_step(
        [s, c, f = find_value(values, "f").value](const StepSample& sample, Vec3& force) {
          const double angle = 2 * M_PI * f * sample.session;
          force += s * std::sin(angle) + c * std::cos(angle);
        });
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const SpectralLine& line = data.line;
    if (line.frequency == 0) return {{0, 0, 0.01, 0, 0, 0, 0.25}};
    const Vec3 &s = line.sine, &c = line.cosine;
    return {{s.x(), s.y(), s.z(), c.x(), c.y(), c.z(), line.frequency}};
  }
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    const SpectralLine& line = data.line;
    if (line.frequency > 0)
      limits[6] = {std::max(0.5 * line.frequency, line.frequency - 2 * line.resolution),
                   line.frequency + 2 * line.resolution};
    return limits;
  }
};

}  // namespace

const Effect& sensor_hum_effect() {
  static const SensorHum effect;
  return effect;
}

}  // namespace hapsim
