// A material that is stiffer (or softer) along one axis.
#include <numbers>

#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kRight = std::numbers::pi / 2;

class Anisotropic : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "anisotropic",
        .stage = Stage::kBody,
        .title = "the material is stiffer along one axis",
        .equation =
            "transversely isotropic: Ea = ratio E along the axis, E across it, Ga = shear sqrt(Ea "
            "E)/(2(1+nu)), nu across, nu sqrt(Ea/E) by tension along it",
        .source =
            "Lekhnitskii, Theory of Elasticity of an Anisotropic Body, 1963; bounds: Lempriere, "
            "AIAA J. 6, 1968",
        .assumptions =
            "one axis for the whole body; the second Poisson's ratio follows from the first, so "
            "that the energy is positive for every ratio",
        .parameters = {{"ratio", "1", "modulus along the axis over that across it", 1, 1.5, 0.02,
                        50, 0.3, true},
                       {"shear", "1", "shear modulus along the axis over the isotropic mean", 1, 1,
                        0.1, 10, 0.3, true},
                       {"tilt", "rad", "angle of the axis to z", 0, 0, -2 * kRight, 2 * kRight, 0.3,
                        false},
                       {"azimuth", "rad", "of the axis about z, from x", 0, 0, -4 * kRight,
                        4 * kRight, 0.3, false}},
        .solved = true,
        .like_shape = true,
        .signature =
            "forces along one direction ask for another modulus than those along the others",
        .confounders = {"sensor-gain", "sensor-rotation", "layer", "friction"},
        .separated_by =
            "sideways presses along x, along y and diagonally; a calibration weight along each "
            "axis of the sensor",
        .kinds = {"direction", "set-up", "body"}};
    return card;
  }
  void describe(const Values& values, MaterialSpec& material) const override {
    add_feature(Feature::kTransverse, values, card(), material);
  }
  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{1.4, 1, 0, 0}, {1.4, 1, kRight, 0.2}, {1.4, 1, kRight, kRight + 0.2}};
  }
};

}  // namespace

const Effect& anisotropic_effect() {
  static const Anisotropic effect;
  return effect;
}

}  // namespace hapsim
