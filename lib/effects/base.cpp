// The bottom is not bonded everywhere, or rests on something that gives.
#include <numbers>

#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kPi = std::numbers::pi;

class Base : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "base",
        .stage = Stage::kSupport,
        .title = "the bottom gives, or is bonded only in part",
        .equation =
            "traction -(E/give) u_n - (E/(3 give)) u_t on the bottom where cos(azimuth) x + "
            "sin(azimuth) y > edge (x, y from its middle), bonded elsewhere",
        .source =
            "Winkler's foundation (1867); Hetenyi, Beams on Elastic Foundation, 1946; nearly no "
            "support as the give grows",
        .assumptions =
            "the boundary of the bonded part is straight in plan view; the support pulls as well "
            "as it pushes",
        .parameters = {{"give", "m",
                        "thickness of a bed with the body's modulus that gives as much", 0, 5e-3,
                        1e-6, 10, 2e-3, true},
                       {"azimuth", "rad", "direction towards the part that gives, from x", 0, 0,
                        -2 * kPi, 2 * kPi, 0.3, false},
                       {"edge", "m", "where that part begins, from the middle of the bottom", 0,
                        -10, -10, 10, 5e-3, false}},
        .needs_positions = true,
        .one_body = true,
        .solved = true,
        // Contact meshes are coarse far from the tool, where the bonded part ends: against another
        // solver's bodies (bench/independent) 4 to 12 % of what it changes.
        .form_error = 0.1,
        .like_shape = true,
        .signature = "too stiff on one side, more so sideways and where the body is thin",
        .confounders = {"regions", "inclusion", "layer", "shift"},
        .separated_by =
            "sideways presses near the edge of the bottom, and a tool of twice the radius",
        .kinds = {"body"}};
    return card;
  }
  void describe(const Values& values, MaterialSpec& material) const override {
    add_feature(Feature::kSupport, values, card(), material);
  }
  // All of it gives a little, or one half is hardly held.
  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    std::vector<std::vector<double>> starts{{5e-3, 0, -10}};
    for (int k = 0; k < 4; ++k) starts.push_back({0.5, 0.1 + k * kPi / 2, 0});
    return starts;
  }
};

}  // namespace

const Effect& base_effect() {
  static const Base effect;
  return effect;
}

}  // namespace hapsim
