// What of a scan's points reconstruction can work with.
#pragma once

#include <string>
#include <vector>

#include "reconstruct/reconstruct.h"

namespace hapsim {

// Points given once, in their order, without what does not change the shape but would end CGAL's
// exact numbers: coordinates of 1e-200 m, normals of other lengths.
PointCloud tame_points(const PointCloud& cloud);

// What no method can use is refused before any of them sees it: Error(kBadInput).
void require_body_points(const std::vector<Vec3>& points, ReconstructMethod method,
                         const std::string& name);

}  // namespace hapsim
