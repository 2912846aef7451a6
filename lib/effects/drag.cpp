// The guides that the tool slides in drag.
#include <algorithm>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// The share of the drag that acts after a step `ds` along an axis, which is taken up within x0.
double taken(double q, double ds, double x0) {
  return std::clamp(q + ds / x0, -1.0, 1.0);
}

Vec3 sizes_of(const Values& values) {
  return {find_value(values, "Dx").value, find_value(values, "Dy").value,
          find_value(values, "Dz").value};
}

// Remembers q and the last place.
class DragStep : public EffectStep {
 public:
  DragStep(const Vec3& D, double x0) : D_(D), x0_(x0) {}
  std::size_t memory() const override { return 6; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    for (int k = 0; k < 3; ++k) {
      double &q = memory[k], &before = memory[3 + k];
      q = sample.first ? 0 : taken(q, sample.u[k] - before, x0_);
      before = sample.u[k];
      f[k] -= D_[k] * q;
    }
  }

 private:
  Vec3 D_;
  double x0_;
};

class Drag : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "drag",
        .stage = Stage::kSensor,
        .title = "the guides that the tool slides in drag",
        .equation =
            "f_k = f_true,k - D_k q_k, q_k,i = min(max(q_k,i-1 + (u_k,i - u_k,i-1) / x0, -1), 1), "
            "k = x, y, z: friction against the motion along each axis, taken up within x0",
        .source =
            "elastic and perfectly plastic element: Prandtl 1928; Visintin, Differential "
            "Models of Hysteresis, III.2",
        .assumptions =
            "guides along the recording's axes; the drag does not depend on the force or the "
            "speed, acts between the body and the sensor, in the air too, and begins with each "
            "press at nothing",
        .parameters = {{"Dx", "N", "drag along x", 0, 0.02, 0, 1e3, 0.02, false},
                       {"Dy", "N", "drag along y", 0, 0.02, 0, 1e3, 0.02, false},
                       {"Dz", "N", "drag along z", 0, 0.02, 0, 1e3, 0.02, false},
                       {"x0", "m", "way within which it is taken up", 1e-5, 1e-5, 1e-7, 1e-2, 1e-5,
                        true, std::numeric_limits<double>::quiet_NaN(), true}},
        .shows_at_starts = true,
        .signature =
            "an offset that goes against the motion: too large a force on the way in and "
            "too small on the way out, the same at any depth",
        .confounders = {"sensor-bias", "touch", "adhesion", "backlash"},
        .separated_by = "the way out again, slowly; the tool moved in the air",
        .kinds = {"rate", "phase", "offset"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& x0 = find_value(values, "x0");
    for (int k = 0; k < 3; ++k)
      apply_along(k, press, find_value(values, card().parameters[k].name), x0, signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<DragStep>(sizes_of(values), find_value(values, "x0").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double D = 0.02 * data.peak_force;
    return {{D, D, D, 1e-5}};
  }

 private:
  static void apply_along(int k, const PressView& press, const ParameterValue& D,
                          const ParameterValue& x0, Signal& signal) {
    const Eigen::Index columns = signal.df.cols();
    const bool moved = press.du.cols() > 0;
    double q = 0;
    Eigen::RowVectorXd dq = Eigen::RowVectorXd::Zero(columns);
    for (std::size_t i = 1; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
      const double ds = press.u[i][k] - press.u[i - 1][k];
      const bool slides = std::abs(q + ds / x0.value) >= 1;
      q = taken(q, ds, x0.value);
      signal.f[row] -= D.value * q;
      if (columns == 0) continue;
      if (slides) {
        dq.setZero();
      } else {
        if (moved) dq += (press.du.row(row) - press.du.row(row - 3)) / x0.value;
        if (x0.column >= 0) dq[x0.column] -= ds / (x0.value * x0.value);
      }
      signal.df.row(row) -= D.value * dq;
      if (D.column >= 0) signal.df(row, D.column) -= q;
    }
  }
};

}  // namespace

const Effect& drag_effect() {
  static const Drag effect;
  return effect;
}

}  // namespace hapsim
