// A closed surface about points or triangles of any kind.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Alpha wrapping (Portaneri and others 2022): closed, manifold and without self-intersection
// whatever is given, about `offset` [m] outside it; gaps narrower than `alpha` [m] are bridged.
// Deterministic. Error(kBadInput) when the points span no volume, Error(kNoConvergence) when
// nothing comes out.
Surface wrap_points(const std::vector<Vec3>& points, double alpha, double offset);
Surface wrap_triangles(const Surface& triangles, double alpha, double offset);

}  // namespace hapsim
