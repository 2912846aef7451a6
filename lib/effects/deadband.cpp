// A force sensor that is blind to small forces.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kSoft = 0.2;  // the edge spreads over this share of the threshold to each side

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
        .separated_by = "a slow shallow press, and small calibration weights"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& d = find_value(values, "d");
    const ParameterValue& k = find_value(values, "k");
    if (d.value <= 0) return;
    for (Eigen::Index row = 0; row < 3 * static_cast<Eigen::Index>(press.size()); ++row) {
      const double size = std::abs(signal.f[row]), sign = signal.f[row] < 0 ? -1 : 1;
      const double t = std::clamp((size / d.value - 1 + kSoft) / (2 * kSoft), 0.0, 1.0);
      const double S = t * t * (3 - 2 * t), slope = 3 * t * (1 - t) / kSoft;  // by size/d
      const double above = size - k.value * d.value;
      signal.f[row] = sign * above * S;
      if (signal.df.cols() == 0) continue;
      signal.df.row(row) *= S + above * slope / d.value;
      if (d.column >= 0)
        signal.df(row, d.column) +=
            sign * (-k.value * S - above * slope * size / (d.value * d.value));
      if (k.column >= 0) signal.df(row, k.column) -= sign * d.value * S;
    }
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
