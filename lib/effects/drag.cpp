// The guide that the tool slides in drags.
#include <algorithm>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// The share of the drag that acts after a step `ds` along the guide, which is taken up within x0.
double taken(double q, double ds, double x0) {
  return std::clamp(q + ds / x0, -1.0, 1.0);
}

// Remembers q and the last way along the guide.
class DragStep : public EffectStep {
 public:
  DragStep(double D, double x0) : D_(D), x0_(x0) {}
  std::size_t memory() const override { return 2; }
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    const double s = sample.u.dot(normal_);
    memory[0] = sample.first ? 0 : taken(memory[0], s - memory[1], x0_);
    memory[1] = s;
    f -= D_ * memory[0] * normal_;
  }

 private:
  double D_, x0_;
  Vec3 normal_ = Vec3::UnitZ();
};

class Drag : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "drag",
        .stage = Stage::kSensor,
        .title = "the guide that the tool slides in drags",
        .equation =
            "f = f_true - D q n, q_i = min(max(q_i-1 + (s_i - s_i-1) / x0, -1), 1), s = u.n: "
            "friction against the motion along the normal n, taken up within x0",
        .source =
            "elastic and perfectly plastic element: Prandtl 1928; Visintin, Differential "
            "Models of Hysteresis, III.2",
        .assumptions =
            "the guide lies along the surface's normal; the drag does not depend on the force or "
            "the speed, acts between the body and the sensor, in the air too, and begins with each "
            "press at nothing",
        .parameters = {{"D", "N", "drag", 0, 0.02, 0, 1e3, 0.02, false},
                       {"x0", "m", "way within which it is taken up", 1e-5, 1e-5, 1e-7, 1e-2, 1e-5,
                        true, std::numeric_limits<double>::quiet_NaN(), true}},
        .shows_at_starts = true,
        .signature =
            "an offset that goes against the motion: too large a force on the way in and "
            "too small on the way out, the same at any depth",
        .confounders = {"sensor-bias", "touch", "adhesion", "backlash"},
        .separated_by = "the way out again, slowly; the tool moved in the air"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue &D = find_value(values, "D"), &x0 = find_value(values, "x0");
    const Vec3& n = press.normal;
    const Eigen::Index columns = signal.df.cols();
    const bool moved = press.du.cols() > 0;
    double q = 0;
    Eigen::RowVectorXd dq = Eigen::RowVectorXd::Zero(columns);
    for (std::size_t i = 1; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const double ds = (press.u[i] - press.u[i - 1]).dot(n);
      const bool slides = std::abs(q + ds / x0.value) >= 1;
      q = taken(q, ds, x0.value);
      signal.f.segment<3>(row) -= D.value * q * n;
      if (columns == 0) continue;
      if (slides) {
        dq.setZero();
      } else {
        if (moved)
          dq += n.transpose() * (press.du.middleRows(row, 3) - press.du.middleRows(row - 3, 3)) /
                x0.value;
        if (x0.column >= 0) dq[x0.column] -= ds / (x0.value * x0.value);
      }
      signal.df.middleRows(row, 3) -= D.value * n * dq;
      if (D.column >= 0) signal.df.block<3, 1>(row, D.column) -= q * n;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<DragStep>(find_value(values, "D").value,
                                      find_value(values, "x0").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0.02 * data.peak_force, 1e-5}};
  }
};

}  // namespace

const Effect& drag_effect() {
  static const Drag effect;
  return effect;
}

}  // namespace hapsim
