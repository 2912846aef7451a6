// Points, displacements and forces in space: metres, newtons, right-handed frame of the scan.
#pragma once

#include <Eigen/Core>

namespace hapsim {

using Vec3 = Eigen::Vector3d;

}  // namespace hapsim
