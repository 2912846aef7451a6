// A ball of another stiffness below the surface.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"

namespace hapsim {
namespace {

class Inclusion : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "inclusion",
        .stage = Stage::kBody,
        .title = "something stiffer or softer lies inside the body",
        .equation = "E(p) = E ratio where |p - (x, y, z)| < radius, else E",
        .source =
            "finite elements, elements cut by the boundary as laminates along it (Backus, J. "
            "Geophys. Res. 67, 1962); thesis 3.5",
        .assumptions =
            "one ball, bonded, the body's Poisson's ratio; its size and its modulus are told apart "
            "only by presses beside and above it",
        .parameters = {{"x", "m", "its centre", 0, 0, -10, 10, 5e-3, false},
                       {"y", "m", "its centre", 0, 0, -10, 10, 5e-3, false},
                       {"z", "m", "its centre", 0, 0, -10, 10, 5e-3, false},
                       {"radius", "m", "its radius", 0, 5e-3, 5e-4, 0.2, 3e-3, true},
                       {"ratio", "1", "its modulus over that around it", 1, 2, 0.02, 50, 0.3,
                        true}},
        .needs_positions = true,
        .one_body = true,
        .solved = true,
        .local = true,
        .like_shape = true,
        .signature = "too soft (or too stiff) at neighbouring positions, and less so further away",
        .confounders = {"regions", "layer", "base", "shift"},
        .separated_by = "presses 5 mm apart around the place, and a second tool radius",
        .kinds = {"body", "place"}};
    return card;
  }
  void describe(const Values& values, MaterialSpec& material) const override {
    add_feature(Feature::kInclusion, values, card(), material);
  }
  // Its centre inside the body, and no larger than that; a ball of more than two thirds of the
  // body's width is a core, and what is around it a skin (layer).
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    for (int k = 0; k < 3; ++k) limits[static_cast<std::size_t>(k)] = {data.low[k], data.high[k]};
    Vec3 size = data.high - data.low;
    std::sort(size.begin(), size.end());
    const double most = std::min(size[0] / 2, size[1] / 3);
    limits[3].second = std::clamp(most, limits[3].first, limits[3].second);
    return limits;
  }
  std::string implausible(const Values& values, const std::vector<Vec3>& pressed) const override {
    const auto value = [&](const char* name) { return find_value(values, name).value; };
    const Vec3 centre(value("x"), value("y"), value("z"));
    for (const Vec3& p : pressed)
      if ((p - centre).norm() < value("radius"))
        return "the ball that would do it reaches the pressed surface: that is a region";
    return "";
  }
  // Under the place that departs most from the others, weighted with its neighbours; at two depths.
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    if (data.places.empty()) return Effect::starts(data, 1);
    const PlaceGain* extreme = &data.places.front();
    for (const PlaceGain& p : data.places)
      if (std::abs(std::log(p.gain)) > std::abs(std::log(extreme->gain))) extreme = &p;
    const bool stiff = extreme->gain > 1;
    double nearest = 1e300;
    for (const PlaceGain& p : data.places)
      if (&p != extreme) nearest = std::min(nearest, (p.point - extreme->point).norm());
    if (!(nearest < 1e300)) nearest = 4 * data.tool_radius;
    Vec3 centre = Vec3::Zero();
    double sum = 0;
    for (const PlaceGain& p : data.places) {
      const double excess = stiff ? std::log(p.gain) : -std::log(p.gain);
      const double near = std::exp(-std::pow((p.point - extreme->point).norm() / nearest, 2));
      const double weight = std::max(0.0, excess) * near;
      centre += weight * p.point;
      sum += weight;
    }
    if (sum > 0) centre /= sum;
    std::vector<std::vector<double>> starts;
    for (const double depth : {2.0, 4.0}) {
      const Vec3 c = centre - depth * data.tool_radius * extreme->normal;
      starts.push_back({c.x(), c.y(), c.z(), 1.5 * data.tool_radius, stiff ? 2.5 : 0.4});
    }
    return starts;
  }
};

}  // namespace

const Effect& inclusion_effect() {
  static const Inclusion effect;
  return effect;
}

}  // namespace hapsim
