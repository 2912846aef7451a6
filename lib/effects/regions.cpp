// Plan-view regions of different stiffness on one mesh.
#include <map>

#include "effects/effects.h"

namespace hapsim {
namespace {

class Regions : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "regions",
        .stage = Stage::kBody,
        .title = "the stiffness differs from place to place",
        .equation = "E(x, y) = E_r, r the region of the key point nearest to (x, y)",
        .source =
            "after thesis 3.5 (regions on one mesh) and 5.2 (regions from location samples); "
            "nearest-neighbour classification: Cover and Hart, 1967",
        .assumptions =
            "regions reach through the whole depth; of two regions the boundary is straight, bent, "
            "round or another smooth curve where the moduli of the positions along it agree with "
            "that, else it lies half-way between positions of different regions",
        .parameters =
            {{"x", "m", "key point of the region, plan view", 0, 0, -10, 10, 0.01, false},
             {"y", "m", "key point of the region, plan view", 0, 0, -10, 10, 0.01, false},
             {"local", "1",
              "1: each contact feels its own modulus alone, between key points one "
              "interpolated from "
              "the nearest (location samples, thesis 5.2.1; moving least squares: Lancaster "
              "and Salkauskas, 1981); 0 or absent: "
              "regions act on each other through the body",
              0, 0, 0, 1, 1, false}},
        .terms = true,
        .needs_positions = true,
        .one_body = true,
        // Boundaries are found between pressed places: against another solver's bodies
        // (bench/independent) 4 to 14 % of what it changes.
        .form_error = 0.1,
        .local = true,
        .like_shape = true,
        .is_map = true,
        .signature = "too stiff at some positions and too soft at others, at all depths and rates",
        .confounders = {"layer", "inclusion", "base", "shift"},
        .separated_by = "new positions between the pressed ones, and a tool of another radius",
        .kinds = {"body", "place"}};
    return card;
  }
  bool relaxation(const Values&, double, std::vector<MaxwellTerm>&) const override { return true; }
  void describe(const Values& values, MaterialSpec& material) const override {
    std::map<std::pair<int, std::string>, Vec3> points;  // by region and number, in file order
    for (const ParameterValue& v : values) {
      if (v.name == "local") {
        material.local = v.value > 0.5;
        continue;
      }
      Vec3& point = points.try_emplace({v.region, v.name.substr(1)}, Vec3::Zero()).first->second;
      point[v.name[0] == 'x' ? 0 : 1] = v.value;
    }
    for (const auto& [key, point] : points) {
      material.key_point.push_back(point);
      material.key_region.push_back(key.first);
    }
  }
};

}  // namespace

const Effect& regions_effect() {
  static const Regions effect;
  return effect;
}

}  // namespace hapsim
