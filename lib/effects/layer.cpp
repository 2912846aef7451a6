// A skin of another stiffness on a core.
#include "effects/effects.h"

namespace hapsim {
namespace {

class Layer : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "layer",
        .stage = Stage::kBody,
        .title = "a skin of another stiffness covers the body",
        .equation = "E(x) = E ratio where x is nearer than `thickness` to the free surface, else E",
        .source =
            "finite elements, elements cut by the boundary as laminates along it (Backus, J. "
            "Geophys. Res. 67, 1962); for a layer on a half-space: Burmister, J. Appl. Phys. 16, "
            "1945",
        .assumptions = "one thickness everywhere, bonded to the core, the core's Poisson's ratio",
        .parameters = {{"thickness", "m", "thickness of the skin", 0, 2e-3, 2e-4, 0.1, 1e-3, true},
                       {"ratio", "1", "modulus of the skin over that of the core", 1, 2, 0.02, 50,
                        0.3, true}},
        .one_body = true,
        .solved = true,
        .like_shape = true,
        .signature =
            "sideways forces and normal ones ask for different moduli, at every position alike",
        .confounders = {"anisotropic", "sensor-gain", "base", "inclusion"},
        .separated_by = "a second tool radius (half or twice), and sideways presses",
        .kinds = {"body"}};
    return card;
  }
  void describe(const Values& values, MaterialSpec& material) const override {
    add_feature(Feature::kLayer, values, card(), material);
  }
  std::string implausible(const Values& values, const std::vector<Vec3>&) const override {
    constexpr double kSoftest = 0.05;  // no skin of tissue is that soft on its body
    if (find_value(values, "ratio").value < kSoftest)
      return "a skin that soft carries nothing: something else makes the first depth easy";
    return "";
  }
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double t = 0.6 * data.tool_radius;
    return {{t, 1.6}, {t, 0.6}};
  }
};

}  // namespace

const Effect& layer_effect() {
  static const Layer effect;
  return effect;
}

}  // namespace hapsim
