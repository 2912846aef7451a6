// Where to press to know better where a lump lies.
#pragma once

#include <vector>

#include "imaging/lump_fit.h"
#include "plan/spread_places.h"

namespace hapsim {

// Places among `places`, one by one, each the one after which the lump's centre is known best
// (least trace of its covariance, A-optimal), about what the presses of `seen` tell. For placing a
// press alone a small lump adds to the gain of a press at p, on a half-space with a disc of radius
// a, in proportion to the energy of a point force's stress there,
//   g(c) = A z^2 / (R^2 + a^2)^3,  R = |c - p|, z = (p - c) . n
// (Boussinesq; nearly incompressible), A as the gains of `seen` have it. Unknown: c, A and what all
// gains have in common. `error`: relative, of a gain. The images themselves are of finite elements.
std::vector<PressablePlace> lump_places(const std::vector<PressablePlace>& places,
                                        const std::vector<SeenPlace>& seen, const Lump& lump,
                                        double tool_radius, double error, std::size_t count);

}  // namespace hapsim
