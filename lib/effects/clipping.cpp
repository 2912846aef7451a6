// A force sensor whose readings end at a largest one.
#include <algorithm>
#include <array>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kNoEnd = 1e6;  // [N]

class Clipping : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "clipping",
        .stage = Stage::kSensor,
        .title = "the force sensor's readings end at a largest one",
        .equation = "f_k = min(max(f_true,k, -L_k), L_k), k = x, y, z",
        .source = "saturation of amplifier and converter",
        .assumptions =
            "the same end for pulling and pressing, of each axis as it is recorded; what was taken "
            "off the readings afterwards (a zero by press, a calibration) moves the end and is not "
            "in it",
        .parameters = {{"Lx", "N", "largest reading along x", kNoEnd, 1, 1e-6, kNoEnd, 0.05, true},
                       {"Ly", "N", "largest reading along y", kNoEnd, 1, 1e-6, kNoEnd, 0.05, true},
                       {"Lz", "N", "largest reading along z", kNoEnd, 1, 1e-6, kNoEnd, 0.05, true}},
        .needs_ceiling = true,
        .signature =
            "forces that follow the model up to one size and stay there exactly, at every place, "
            "without noise",
        .confounders = {"sensor-curve", "softening", "friction"},
        .separated_by = "a sensor of a larger range, or presses that stay below its end",
        .kinds = {"reading", "depth"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    for (int k = 0; k < 3; ++k) {
      const ParameterValue& L = find_value(values, card().parameters[k].name);
      for (std::size_t i = 0; i < press.size(); ++i) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
        double& f = signal.f[row];
        if (std::abs(f) <= L.value) continue;
        const double sign = f > 0 ? 1 : -1;
        f = sign * L.value;
        if (signal.df.cols() == 0) continue;
        signal.df.row(row).setZero();
        if (L.column >= 0) signal.df(row, L.column) = sign;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    std::array<double, 3> L;
    for (std::size_t k = 0; k < 3; ++k) L[k] = find_value(values, card().parameters[k].name).value;
    return map_step([L](const StepSample&, Vec3& f) {
      for (int k = 0; k < 3; ++k) f[k] = std::clamp(f[k], -L[k], L[k]);
    });
  }

  // Where the readings themselves end; else where some forces would.
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const bool seen = !data.ceiling.isZero();
    std::vector<double> start;
    for (int k = 0; k < 3; ++k)
      start.push_back(!seen                 ? 0.5 * data.peak_force
                      : seen_along(k, data) ? data.ceiling[k]
                                            : kNoEnd);
    return {start};
  }
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    constexpr double kNear = 0.05;
    auto limits = Effect::limits(data);
    for (int k = 0; k < 3; ++k)
      if (seen_along(k, data))
        limits[static_cast<std::size_t>(k)] = {(1 - kNear) * data.ceiling[k],
                                               (1 + kNear) * data.ceiling[k]};
    return limits;
  }

 private:
  static bool seen_along(int k, const DataSummary& data) { return data.ceiling[k] > 0; }
};

}  // namespace

const Effect& clipping_effect() {
  static const Clipping effect;
  return effect;
}

}  // namespace hapsim
