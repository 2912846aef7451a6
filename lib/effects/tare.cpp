// An offset of the force sensor that is another one in every press.
#include <array>
#include <map>
#include <string>
#include <utility>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class Tare : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "tare",
        .stage = Stage::kSensor,
        .title = "the force sensor was zeroed anew, and differently, before every press",
        .equation = "f = f_true + b_p, p the number of the press",
        .source = "zero offset of strain-gauge force sensors, taken from a moment of noise",
        .assumptions =
            "constant within a press; the offsets belong to the recording, presses beyond it have "
            "none; solved for within every fit, and all of them counted as parameters",
        .parameters = {{"bx1", "N", "offset along x in the first press", 0, 0, -1e6, 1e6, 0.1,
                        false},
                       {"by1", "N", "offset along y", 0, 0, -1e6, 1e6, 0.1, false},
                       {"bz1", "N", "offset along z", 0, 0, -1e6, 1e6, 0.1, false}},
        .per_press = true,
        .signature =
            "an error that is constant within a press, in the air as well, but not from "
            "press to press",
        .confounders = {"sensor-bias", "sensor-drift"},
        .separated_by = "samples in the air before and after every press",
        .contains = {"sensor-bias"},
        .kinds = {"offset", "zero-of-press", "drift"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const std::string number = std::to_string(press.number);
    const std::array<std::string, 3> names{"bx" + number, "by" + number, "bz" + number};
    for (const ParameterValue& b : values)
      for (int k = 0; k < 3; ++k) {
        if (b.name != names[k]) continue;
        for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(press.size()); ++i) {
          signal.f[3 * i + k] += b.value;
          if (b.column >= 0 && signal.df.cols() > 0) signal.df(3 * i + k, b.column) += 1;
        }
      }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    std::map<int, Vec3> offset;  // by press
    for (const ParameterValue& b : values) {
      const int number = std::stoi(b.name.substr(2));
      offset.try_emplace(number, Vec3::Zero()).first->second[b.name[1] - 'x'] += b.value;
    }
    return map_step([offset = std::move(offset)](const StepSample& sample, Vec3& f) {
      const auto found = offset.find(sample.number);
      if (found != offset.end()) f += found->second;
    });
  }
};

}  // namespace

const Effect& tare_effect() {
  static const Tare effect;
  return effect;
}

}  // namespace hapsim
