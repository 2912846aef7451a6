// A force sensor whose axes show shares of each other's force.
#include <array>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

struct Share {
  int shown, of;  // axes
};
// In the order of the card's parameters.
constexpr std::array<Share, 6> kShares{{{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}}};

Eigen::Matrix3d matrix_of(const Values& values, const EffectCard& card) {
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < kShares.size(); ++k)
    M(kShares[k].shown, kShares[k].of) = find_value(values, card.parameters[k].name).value;
  return M;
}

ParameterCard share(const std::string& name, const std::string& shown, const std::string& of) {
  return {name, "1", "share of f" + of + " that " + shown + " shows", 0, 0, -1, 1, 0.02, false};
}

class SensorCrosstalk : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-crosstalk",
        .stage = Stage::kSensor,
        .title = "axes of the force sensor show shares of each other",
        .equation = "f = C f_true, C = [1 cxy cxz; cyx 1 cyz; czx czy 1]",
        .source = "calibration matrix of a force sensor, its off-diagonal terms",
        .assumptions =
            "the same shares during the whole session; the diagonal is 1, for one axis's gain is "
            "another effect and a common one looks like Young's modulus. Equal shares of opposite "
            "sign are a sensor that is mounted askew, which is this one with three values instead "
            "of six",
        .parameters = {share("cxy", "x", "y"), share("cxz", "x", "z"), share("cyx", "y", "x"),
                       share("cyz", "y", "z"), share("czx", "z", "x"), share("czy", "z", "y")},
        .signature =
            "sideways forces in the proportion of the normal force, everywhere alike, "
            "while sideways presses do not change the normal force as a turned sensor has "
            "it",
        .confounders = {"sensor-rotation", "sensor-gain", "anisotropic", "shift"},
        .separated_by = "a calibration weight along each axis; sideways presses both ways",
        .contains = {"sensor-rotation"},
        .kinds = {"set-up", "direction"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const Eigen::Matrix3d M = matrix_of(values, card());
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const Eigen::Vector3d f = signal.f.segment<3>(3 * i);
      signal.f.segment<3>(3 * i) = M * f;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(3 * i, 3) = (M * signal.df.middleRows(3 * i, 3)).eval();
      for (std::size_t k = 0; k < kShares.size(); ++k)
        if (const int column = find_value(values, card().parameters[k].name).column; column >= 0)
          signal.df(3 * i + kShares[k].shown, column) += f[kShares[k].of];
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return map_step(
        [M = matrix_of(values, card())](const StepSample&, Vec3& f) { f = (M * f).eval(); });
  }
};

}  // namespace

const Effect& sensor_crosstalk_effect() {
  static const SensorCrosstalk effect;
  return effect;
}

}  // namespace hapsim
