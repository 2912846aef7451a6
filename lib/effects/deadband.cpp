// A force sensor that is blind to small forces.
#include <algorithm>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kSoft = 0.2;  // the edge spreads over this share of the threshold to each side

// f = sign above S; slope: of S by size/d.
struct Reading {
  double size = 0, sign = 1, S = 0, slope = 0, above = 0;
};
Reading reading(double f, double d, double k) {
  const double size = std::abs(f);
  const double t = std::clamp((size / d - 1 + kSoft) / (2 * kSoft), 0.0, 1.0);
  return {size, f < 0 ? -1.0 : 1.0, t * t * (3 - 2 * t), 3 * t * (1 - t) / kSoft, size - k * d};
}

class Deadband : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "deadband",
        .stage = Stage::kSensor,
        .title = "the force sensor reads nothing below a threshold",
        .equation =
            "f = sign(f_true) (|f_true| - k d) S(|f_true|/d) on each axis; S rises smoothly from 0 "
            "to 1 between 0.8 and 1.2",
        .source = "dead zone of amplifiers and of filters that suppress noise",
        .assumptions = "one threshold for all axes; the edge is softened to be differentiable",
        .parameters = {{"d", "N", "threshold", 0, 0.05, 0, 1e6, 0.05, false},
                       {"k", "1",
                        "share of the threshold that stays missing above it: 0 reads the true "
                        "force there, 1 counts from the threshold",
                        0, 0.5, 0, 1, 0.3, false}},
        .signature = "readings of zero at small forces, and a constant loss above them",
        .confounders = {"sensor-bias", "slack", "adhesion", "sensor-curve"},
        .separated_by = "a slow shallow press, and small calibration weights",
        .kinds = {"reading", "depth"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& d = find_value(values, "d");
    const ParameterValue& k = find_value(values, "k");
    if (d.value <= 0) return;
    for (Eigen::Index row = 0; row < 3 * static_cast<Eigen::Index>(press.size()); ++row) {
      const auto [size, sign, S, slope, above] = reading(signal.f[row], d.value, k.value);
      signal.f[row] = sign * above * S;
      if (signal.df.cols() == 0) continue;
      signal.df.row(row) *= S + above * slope / d.value;
      if (d.column >= 0)
        signal.df(row, d.column) +=
            sign * (-k.value * S - above * slope * size / (d.value * d.value));
      if (k.column >= 0) signal.df(row, k.column) -= sign * d.value * S;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const double d = find_value(values, "d").value, k = find_value(values, "k").value;
    if (d <= 0) return nullptr;
    return map_step([d, k](const StepSample&, Vec3& f) {
      for (int axis = 0; axis < 3; ++axis) {
        const Reading r = reading(f[axis], d, k);
        f[axis] = r.sign * r.above * r.S;
      }
    });
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double peak = data.peak_force;
    return {{0.02 * peak, 0.02}, {0.02 * peak, 0.98}, {0.1 * peak, 0.02}, {0.1 * peak, 0.98}};
  }
};

}  // namespace

const Effect& deadband_effect() {
  static const Deadband effect;
  return effect;
}

}  // namespace hapsim
