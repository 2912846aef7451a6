// A force sensor that reads otherwise while the force grows than while it falls.
#include <algorithm>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// How far the reading has turned to the way in which the force changes, which takes a share r of
// the largest force M.
double turned(double q, double change, double r, double M) {
  return M > 0 ? std::clamp(q + change / (r * M), -1.0, 1.0) : 0.0;
}

// Remembers q, the last force and the largest one, of each axis.
class SensorHysteresisStep : public EffectStep {
 public:
  SensorHysteresisStep(double h, double r) : h_(h), r_(r) {}
  std::size_t memory() const override { return 9; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    for (int k = 0; k < 3; ++k) {
      double &q = memory[k], &before = memory[3 + k], &M = memory[6 + k];
      if (sample.first) q = before = M = 0;
      M = std::max(M, std::abs(f[k]));
      q = turned(q, f[k] - before, r_, M);
      before = f[k];
      f[k] -= h_ * q * std::abs(f[k]);
    }
  }

 private:
  double h_, r_;
};

class SensorHysteresis : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-hysteresis",
        .stage = Stage::kSensor,
        .title = "the force sensor reads less while the force grows than while it falls",
        .equation =
            "f_k = f_true,k - h q_k |f_true,k|, q_k,i = min(max(q_k,i-1 + (f_true,k,i - "
            "f_true,k,i-1) / (r M_k,i), -1), 1), M_k the largest |f_true,k| of the press so far, k "
            "= x, y, z",
        .source =
            "elastic and perfectly plastic element (Prandtl 1928) in the force; its size goes with "
            "the load, as in a body with structural damping (Kimball and Lovell 1927), and so a "
            "loop closes where the force is nothing",
        .assumptions =
            "one share for all axes, each by its own force; independent of the rate; begins with "
            "each press at nothing",
        .parameters = {{"h", "1",
                        "share of the force that it reads too little while that grows, "
                        "and too much while it falls",
                        0, 0.02, 0, 0.5, 0.02, false},
                       {"r", "1", "share of the largest force within which it turns", 0.2, 0.2,
                        0.02, 2, 0.2, true}},
        .needs_return = true,
        .screened = true,
        .signature =
            "too large a force on the way out, in proportion to the force and at any speed, and "
            "none too large at its ends",
        .confounders = {"drag", "backlash", "adhesion", "softening", "viscoelastic"},
        .separated_by =
            "weights put on the sensor and taken off one by one; presses that go back at several "
            "depths, slow and fast",
        .kinds = {"phase", "history", "reading"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue &h = find_value(values, "h"), &r = find_value(values, "r");
    for (int k = 0; k < 3; ++k) apply_along(k, press, h, r, signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<SensorHysteresisStep>(find_value(values, "h").value,
                                                  find_value(values, "r").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{0.03, 0.3}, {0.03, 0.06}};
  }

 private:
  static void apply_along(int k, const PressView& press, const ParameterValue& h,
                          const ParameterValue& r, Signal& signal) {
    const Eigen::Index columns = signal.df.cols();
    double q = 0, before = 0, M = 0;
    Eigen::RowVectorXd dq = Eigen::RowVectorXd::Zero(columns), dbefore = dq, dM = dq;
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
      const double f = signal.f[row], size = std::abs(f), change = f - before;
      const Eigen::RowVectorXd df = signal.df.row(row);
      const double sign = f < 0 ? -1 : 1;
      if (size > M) {
        M = size;
        dM = sign * df;
      }
      if (M > 0) {
        const double to = q + change / (r.value * M);
        q = turned(q, change, r.value, M);
        if (std::abs(to) >= 1) {
          dq.setZero();
        } else if (columns > 0) {
          dq += (df - dbefore - change / M * dM) / (r.value * M);
          if (r.column >= 0) dq[r.column] -= change / (r.value * r.value * M);
        }
      }
      before = f;
      dbefore = df;
      signal.f[row] -= h.value * q * size;
      if (columns == 0) continue;
      signal.df.row(row) -= h.value * (size * dq + q * sign * df);
      if (h.column >= 0) signal.df(row, h.column) -= q * size;
    }
  }
};

}  // namespace

const Effect& sensor_hysteresis_effect() {
  static const SensorHysteresis effect;
  return effect;
}

}  // namespace hapsim
