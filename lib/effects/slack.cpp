// The body cannot pull a tool that is not bonded to it.
#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

class SlackStep : public EffectStep {
 public:
  explicit SlackStep(double enabled) : enabled_(enabled) {}
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void apply(const StepSample&, double*, Vec3& f) noexcept override {
    if (f.dot(normal_) < 0) f *= 1 - enabled_;
  }

 private:
  double enabled_;
  Vec3 normal_ = Vec3::UnitZ();
};

class Slack : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "slack",
        .stage = Stage::kContact,
        .title = "the body cannot pull the tool",
        .equation = "f = 0 where f_before . n < 0, n the outward normal",
        .source = "unilateral contact: Signorini's condition; Johnson, Contact Mechanics, 1.5",
        .assumptions = "the tool leaves as a whole, and touches again where it left",
        .parameters = {{"enabled", "1", "1: the contact opens instead of pulling", 0, 1, 0, 1, 1,
                        false, std::numeric_limits<double>::quiet_NaN(), true}},
        .signature = "a simulated pull while the tool leaves or is above the surface",
        .confounders = {"adhesion", "deadband", "viscoelastic"},
        .separated_by = "samples of the tool leaving, until it is well clear of the body",
        .kinds = {"depth", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& enabled = find_value(values, "enabled");
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      if (f.dot(press.normal) >= 0) continue;
      signal.f.segment<3>(row) *= 1 - enabled.value;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(row, 3) *= 1 - enabled.value;
      if (enabled.column >= 0) signal.df.block<3, 1>(row, enabled.column) -= f;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<SlackStep>(find_value(values, "enabled").value);
  }
};

}  // namespace

const Effect& slack_effect() {
  static const Slack effect;
  return effect;
}

}  // namespace hapsim
