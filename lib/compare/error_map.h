// The local error spread over the body's surface.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct ErrorMap {
  Surface surface;               // refined where triangles are coarse against the reach
  std::vector<double> error;     // one a vertex [N]; beyond any reach that of the nearest position
  std::vector<double> distance;  // one a vertex: to the nearest position [m]
  double reach = 0;              // [m]
};

// Error of a vertex: mean of the positions' errors weighted by (1/distance - 1/reach)^2, which
// falls to zero at `reach` (Franke & Little's form of inverse distances; reach 0: one and a half
// times the median distance from a position to its nearest neighbour, between 2 % and 15 % of the
// surface's diagonal). Triangles longer than a fourth of the reach are halved, up to about 60,000
// triangles.
ErrorMap map_error(const Surface& surface, const std::vector<Vec3>& positions,
                   const std::vector<double>& error, double reach = 0);

}  // namespace hapsim
