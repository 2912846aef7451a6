// Normals turned towards what saw the points.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Turns every normal by which its point would have been seen from behind (to_sensor: unit, from the
// point to the sensor, as many as points). Returns how many were turned against a clear view (more
// than 30 degrees off grazing).
std::size_t face_sensor(PointCloud& cloud, const std::vector<Vec3>& to_sensor);

}  // namespace hapsim
