// A press that begins elsewhere than the recording says.
#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// Whether a sample that was recorded below the surface lies above it then.
bool has_left(const Vec3& recorded, const Vec3& moved, const Vec3& normal) {
  return recorded.dot(normal) < 0 && moved.dot(normal) >= 0;
}

class TouchStep : public EffectStep {
 public:
  explicit TouchStep(double d) : d_(d) {}
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void move(StepSample& sample, double*) noexcept override {
    if (sample.in_air) return;
    const Vec3 moved = sample.u - d_ * normal_;
    sample.u = has_left(sample.u, moved, normal_) ? Vec3(Vec3::Zero()) : moved;
  }

 private:
  double d_;
  Vec3 normal_ = Vec3::UnitZ();
};

class Touch : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "touch",
        .stage = Stage::kMotion,
        .title = "the contact begins earlier or later than the recording says",
        .equation = "u -> u - d n where the tool is in contact, n the outward normal; 0 above it",
        .source =
            "the contact point as a parameter: Dimitriadis et al., Biophys. J. 82, 2002; Crick "
            "and Yin, Biomech. Model. Mechanobiol. 6, 2007",
        .assumptions = "the same for all presses; samples that are called air stay air",
        .parameters = {{"d", "m", "how much deeper the tool stands than is recorded", 0, 1e-5,
                        -0.05, 0.05, 1e-4, false}},
        .signature = "too soft from the first contact on (or too stiff), by the same depth",
        .confounders = {"tip", "sensor-bias", "deadband", "hyperelastic"},
        .separated_by = "an approach from clear of the body, recorded sample by sample",
        .kinds = {"depth", "offset"}};
    return card;
  }

  void move(const PressView& press, const Values& values, Motion& motion) const override {
    const ParameterValue& d = find_value(values, "d");
    if (d.value == 0 && d.column < 0) return;
    if (d.column >= 0) motion.make_du();
    for (std::size_t i = 0; i < motion.u.size(); ++i) {
      if (press.in_air[i]) continue;
      const Vec3 moved = motion.u[i] - d.value * press.normal;
      const bool left = has_left(motion.u[i], moved, press.normal);
      motion.u[i] = left ? Vec3(Vec3::Zero()) : moved;
      if (motion.du.cols() == 0) continue;
      auto du = motion.du.middleRows(3 * static_cast<Eigen::Index>(i), 3);
      if (left)
        du.setZero();
      else if (d.column >= 0)
        du.col(d.column) -= press.normal;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const double d = find_value(values, "d").value;
    if (d == 0) return nullptr;
    return std::make_unique<TouchStep>(d);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0.03 * data.depth}, {-0.03 * data.depth}};
  }
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    return {{-0.5 * data.depth, 0.5 * data.depth}};
  }
  // A ball's force grows from nothing at the first touch, so where that was is in its modulus; of
  // many presses each is off by its own.
  bool doubted(const DataSummary& data) const override {
    return data.ball_radius > 0 && data.presses <= kFewPresses;
  }

 private:
  static constexpr std::size_t kFewPresses = 5;
};

}  // namespace

const Effect& touch_effect() {
  static const Touch effect;
  return effect;
}

}  // namespace hapsim
