// A surface that is under tension before it is pressed.
#include "effects/effects.h"

namespace hapsim {
namespace {

class PreStress : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "pre-stress",
        .stage = Stage::kBody,
        .title = "the surface is under tension before it is pressed",
        .equation =
            "to the body's energy is added (T/2) int |grad_s (u.n)|^2 over the free surface, T = E "
            "length a tension [N/m] that is the same everywhere and in every direction",
        .source =
            "a membrane under tension (Timoshenko and Woinowsky-Krieger, Theory of Plates and "
            "Shells, 1959); the length as in elastocapillarity: Style et al., Annu. Rev. Condens. "
            "Matter Phys. 8, 2017",
        .assumptions =
            "to first order in the displacement; the tension does not change with the press, so "
            "that "
            "ways along the surface do not change it; the curvature that it has given the body is "
            "in "
            "the scan",
        .parameters = {{"length", "m", "tension over Young's modulus", 0, 5e-4, 0, 1, 5e-4, false}},
        .one_body = true,
        .solved = true,
        .like_shape = true,
        .signature =
            "normal forces ask for a larger modulus than sideways ones, at every position alike",
        .confounders = {"anisotropic", "layer", "sensor-gain", "arm-compliance"},
        .separated_by =
            "a second tool radius (half or twice): what a tension adds does not grow with it as "
            "the body's stiffness does",
        .kinds = {"set-up", "direction", "body"}};
    return card;
  }
  void describe(const Values& values, MaterialSpec& material) const override {
    add_feature(Feature::kTension, values, card(), material);
  }
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0.1 * data.tool_radius}};
  }
};

}  // namespace

const Effect& pre_stress_effect() {
  static const PreStress effect;
  return effect;
}

}  // namespace hapsim
