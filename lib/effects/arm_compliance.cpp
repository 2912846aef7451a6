// A robot that gives way behind the tool.
#include <Eigen/Dense>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

Eigen::Matrix3d compliance_of(const Values& values, const EffectCard& card) {
  Vec3 c;
  for (int k = 0; k < 3; ++k) c[k] = find_value(values, card.parameters[k].name).value;
  return c.asDiagonal();
}

// What a compliance C in series leaves of the force of a body of stiffness K.
Eigen::Matrix3d left_by(const Eigen::Matrix3d& C, const Eigen::Matrix3d& K) {
  return (Eigen::Matrix3d::Identity() + K * C).inverse();
}

class ArmStep : public EffectStep {
 public:
  explicit ArmStep(const Eigen::Matrix3d& C) : C_(C) {}
  void take_place(const StepPlace& place) noexcept override {
    left_ = left_by(C_, place.contact.K);
  }
  void apply(const StepSample&, double*, Vec3& f) noexcept override { f = (left_ * f).eval(); }

 private:
  Eigen::Matrix3d C_, left_ = Eigen::Matrix3d::Identity();
};

class ArmCompliance : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "arm-compliance",
        .stage = Stage::kContact,
        .title = "the arm that holds the tool bends",
        .equation =
            "u = u_recorded + C f, C = diag(cx, cy, cz), f the body's force on the tool; with f = "
            "-K u, K the body's elastic stiffness at the place: f = (I + K C)^-1 f(u_recorded)",
        .source = "springs in series; stiffness of a robot at its tip: Salisbury, IEEE CDC 1980",
        .assumptions =
            "one compliance for all places and poses, along the recording's axes; the tool does "
            "not turn. Exact for an elastic body; of one that relaxes, K is the relaxed stiffness: "
            "a force that is still larger by the share e comes out too large by e KC/(1 + KC) of "
            "itself (e = 0.5, KC = 0.1: 4.5 %), and right once it has relaxed. In one direction at "
            "one stiffness it is a softer body",
        .parameters = {{"cx", "m/N", "compliance along x", 0, 1e-4, 0, 1, 1e-4, false},
                       {"cy", "m/N", "compliance along y", 0, 1e-4, 0, 1, 1e-4, false},
                       {"cz", "m/N", "compliance along z", 0, 1e-4, 0, 1, 1e-4, false}},
        .signature =
            "the force errs by a factor along each axis of the recording, the more the "
            "stiffer the place",
        .confounders = {"anisotropic", "layer", "motion-scale", "sensor-gain"},
        .separated_by =
            "press a rigid plate with the same robot: all that moves there is the arm; "
            "or a second tool radius",
        .kinds = {"set-up", "direction"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const Eigen::Matrix3d C = compliance_of(values, card()), &K = press.contact.K;
    const Eigen::Matrix3d left = left_by(C, K);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const Vec3 f = left * signal.f.segment<3>(3 * i);
      signal.f.segment<3>(3 * i) = f;
      if (signal.df.cols() == 0) continue;
      // (I + K C) df = df(u_recorded) - (dK C + K dC) f.
      auto df = signal.df.middleRows(3 * i, 3);
      for (const auto& [column, dK] : press.contact.by_column) df.col(column) -= dK * C * f;
      for (int k = 0; k < 3; ++k)
        if (const int column = find_value(values, card().parameters[k].name).column; column >= 0)
          df.col(column) -= f[k] * K.col(k);
      df = (left * df).eval();
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<ArmStep>(compliance_of(values, card()));
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double c = 0.1 / data.peak_stiffness;
    return {{c, c, c}};
  }
};

}  // namespace

const Effect& arm_compliance_effect() {
  static const ArmCompliance effect;
  return effect;
}

}  // namespace hapsim
