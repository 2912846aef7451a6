// Play in the drive that moves the tool.
#include <algorithm>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// e of the sample after one with `e`, for a drive at s.
double taken_up(double e, double s, double g) {
  return std::min(std::max(e, s), s + g);
}

// Remembers e, the deepest displacement of the press and its direction. Whatever is deeper than all
// before it has taken the gap up, so that e needs no turning when the direction changes.
class BacklashStep : public EffectStep {
 public:
  explicit BacklashStep(double g) : g_(g) {}
  std::size_t memory() const override { return 5; }
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void move(StepSample& sample, double* memory) noexcept override {
    double &e = memory[0], &deepest = memory[1];
    Eigen::Map<Vec3> d(memory + 2);
    if (sample.first) {
      deepest = 0;
      d = -normal_;
    }
    const double depth = sample.recorded.norm();
    if (depth > deepest && sample.recorded.dot(normal_) <= 0 && !sample.in_air) {
      deepest = depth;
      d = sample.recorded / depth;
    }
    const double s = sample.u.dot(d);
    e = sample.first ? s : taken_up(e, s, g_);
    sample.u += (e - s) * d;
  }

 private:
  double g_;
  Vec3 normal_ = Vec3::UnitZ();
};

class Backlash : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "backlash",
        .stage = Stage::kMotion,
        .title = "the tool lags behind its drive when the motion reverses",
        .equation =
            "s = u.d, d the direction of the press; e_i = min(max(e_i-1, s_i), s_i + g): the play "
            "operator, taken up while moving in; u = u_recorded + (e - s) d",
        .source = "play operator: Visintin, Differential Models of Hysteresis, III.2",
        .assumptions =
            "the gap is taken up on the way in, so that the contact point is right; it opens along "
            "the direction of the press alone",
        .parameters = {{"g", "m", "gap", 0, 1e-4, 0, 0.01, 1e-4, false}},
        .needs_return = true,
        .signature = "too soft while the tool moves out, right while it moves in, at any speed",
        .confounders = {"adhesion", "softening", "viscoelastic"},
        .separated_by =
            "a press in steps that reverse at several depths, slowly, with the tip's own motion "
            "measured",
        .kinds = {"depth", "phase"},
        .looks_ahead = true,
        .live =
            "the direction of a press is known when it is over; sample by sample d is that of the "
            "deepest displacement so far, which is the same as long as it goes straight"};
    return card;
  }

  void move(const PressView& press, const Values& values, Motion& motion) const override {
    const ParameterValue& g = find_value(values, "g");
    if (g.column >= 0) motion.make_du();
    const bool wanted = motion.du.cols() > 0;
    const Vec3& d = press.direction;
    double e = 0;
    Eigen::RowVectorXd de = Eigen::RowVectorXd::Zero(motion.du.cols());
    for (std::size_t i = 0; i < motion.u.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const double s = motion.u[i].dot(d);
      Eigen::RowVectorXd ds;
      if (wanted) ds = d.transpose() * motion.du.middleRows(row, 3);
      if (i == 0 || e <= s) {
        e = s;
        de = ds;
      } else if (e > s + g.value) {
        e = s + g.value;
        de = ds;
        if (g.column >= 0) de[g.column] += 1;
      }
      motion.u[i] += (e - s) * d;
      if (wanted) motion.du.middleRows(row, 3) += d * (de - ds);
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<BacklashStep>(find_value(values, "g").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0.01 * data.depth}, {0.08 * data.depth}};
  }
};

}  // namespace

const Effect& backlash_effect() {
  static const Backlash effect;
  return effect;
}

}  // namespace hapsim
