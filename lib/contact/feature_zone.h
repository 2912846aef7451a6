// Features that fill a part of the body with another modulus: a skin, a ball.
#pragma once

#include <memory>

#include "material/body_features.h"
#include "mesh/surface_tree.h"
#include "solid/level_set.h"

namespace hapsim {

bool is_zone(Feature kind);
// Where the zone lies; the level set's parameters are the zone's values but for the last one, its
// modulus over that around it. `free_surface`: what a skin lies under.
LevelSet zone_level(const BodyFeature& zone,
                    const std::shared_ptr<const SurfaceTree>& free_surface);

}  // namespace hapsim
