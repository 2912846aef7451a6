// The object has moved between scan and measurement.
#include "effects/effects.h"

namespace hapsim {
namespace {

class Shift : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "shift",
        .stage = Stage::kSupport,
        .title = "the object moved between scan and measurement",
        .equation =
            "K(x) = R K_scan(R' (x - m - d) + m) R', R the rotation by (rx, ry, rz) about the "
            "middle "
            "m of the contact points, d = (dx, dy, dz)",
        .source =
            "registration of points to a surface: Chen and Medioni, Image and Vision Computing 10, "
            "1992",
        .assumptions =
            "the recorded contact points lie on the moved surface; the move is found from them "
            "alone, so what slides the surface along itself stays unknown, and is taken as none",
        .parameters = {{"dx", "m", "move along x", 0, 0, -1, 1, 1e-3, false, kNoLimit, true},
                       {"dy", "m", "move along y", 0, 0, -1, 1, 1e-3, false, kNoLimit, true},
                       {"dz", "m", "move along z", 0, 0, -1, 1, 1e-3, false, kNoLimit, true},
                       {"rx", "rad", "rotation vector", 0, 0, -1, 1, 0.01, false, kNoLimit, true},
                       {"ry", "rad", "rotation vector", 0, 0, -1, 1, 0.01, false, kNoLimit, true},
                       {"rz", "rad", "rotation vector", 0, 0, -1, 1, 0.01, false, kNoLimit, true}},
        .needs_positions = true,
        .one_body = true,
        .one_tool = true,
        .moves_body = true,
        .signature =
            "contact points off the scanned surface, stiffness and directions wrong by place",
        .confounders = {"sensor-rotation", "regions", "base"},
        .separated_by =
            "a few points touched on the object again, on slopes of different directions",
        .kinds = {"body"}};
    return card;
  }
  void describe(const Values& values, MaterialSpec& material) const override {
    const auto& cards = card().parameters;
    for (int k = 0; k < 3; ++k) {
      material.shift[k] = find_value(values, cards[static_cast<std::size_t>(k)].name).value;
      material.rotation[k] = find_value(values, cards[static_cast<std::size_t>(k) + 3].name).value;
    }
  }
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const Vec3 &d = data.shift, &r = data.rotation;
    return {{d.x(), d.y(), d.z(), r.x(), r.y(), r.z()}};
  }

 private:
  static constexpr double kNoLimit = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

const Effect& shift_effect() {
  static const Shift effect;
  return effect;
}

}  // namespace hapsim
