// Isotropic linear elasticity: Young's modulus of each region and one Poisson's ratio.
#include "effects/effects.h"

namespace hapsim {
namespace {

class Elastic : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "elastic",
        .stage = Stage::kBody,
        .title = "the body is elastic",
        .equation =
            "sigma = lambda tr(eps) I + 2 mu eps, lambda = E nu/((1+nu)(1-2nu)), "
            "mu = E/(2(1+nu)); f = -K(E, nu) u",
        .source = "Hooke's law; Zienkiewicz and Taylor, The Finite Element Method, vol. 1",
        .assumptions =
            "small strains, isotropic, one Poisson's ratio for the whole body; with "
            "relaxation, E is the modulus after all of it; E of regions 1, 2, ... lies where the "
            "key "
            "points of regions are or, without any, where the body's tetrahedra have that number "
            "(hs-tetmesh --region)",
        .parameters = {{"E", "Pa", "Young's modulus (one row a region)", 0, 1e4, 1, 1e12, 1e4,
                        true},
                       {"nu", "1", "Poisson's ratio", 0, 0.4, 0, 0.499, 0.1, false, 0.5}},
        .of_region = {{"growth", "m",
                       "by how much the region's boundary lies outside of that of the body's "
                       "tetrahedra with its number",
                       0, 0, -0.02, 0.02, 1e-3, false}},
        .modulus = "E",
        .poissons_ratio = "nu",
        .signature = "no body at all",
        .confounders = {},
        .separated_by = "a calibration weight: a common gain of the force sensor looks like E"};
    return card;
  }
  bool relaxation(const Values&, double, std::vector<MaxwellTerm>&) const override { return true; }
  void describe(const Values& values, MaterialSpec& material) const override {
    for (const ParameterValue& v : values) {
      if (v.name == "nu") {
        material.nu = v.value;
        material.nu_column = v.column;
      } else if (v.name == "growth") {
        FeatureSpec spec{{Feature::kGrowth, {}}, {}};
        spec.feature.value = {static_cast<double>(v.region), v.value};
        spec.column = {-1, v.column};
        material.features.push_back(std::move(spec));
      } else {
        const std::size_t region = static_cast<std::size_t>(v.region);
        if (material.modulus.size() <= region) {
          material.modulus.resize(region + 1, v.value);
          material.modulus_column.resize(region + 1, -1);
        }
        material.modulus[region] = v.value;
        material.given.push_back(v.region);
        material.modulus_column[region] = v.column;
      }
    }
  }
};

}  // namespace

const Effect& elastic_effect() {
  static const Elastic effect;
  return effect;
}

}  // namespace hapsim
