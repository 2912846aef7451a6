#include "contact/feature_zone.h"

#include <cmath>

namespace hapsim {
namespace {

// A ball: the distance to it. Parameters: centre x, y, z, radius.
LevelSet ball_level(const Vec3& centre, double radius) {
  return [centre, radius](const Vec3& p) {
    const Vec3 d = p - centre;
    const double r = d.norm();
    LevelValue level{r - radius, Eigen::VectorXd::Zero(4), std::abs(r - radius)};
    if (r > 0) level.by_parameters.head<3>() = -d / r;
    level.by_parameters[3] = -1;
    return level;
  };
}

}  // namespace

bool is_zone(Feature kind) {
  return kind == Feature::kLayer || kind == Feature::kInclusion;
}

LevelSet zone_level(const BodyFeature& zone,
                    const std::shared_ptr<const SurfaceTree>& free_surface) {
  if (zone.kind == Feature::kLayer) return layer_level(free_surface, zone.value[0]);
  return ball_level({zone.value[0], zone.value[1], zone.value[2]}, zone.value[3]);
}

}  // namespace hapsim
