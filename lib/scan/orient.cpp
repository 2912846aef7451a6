#include "scan/orient.h"

namespace hapsim {

std::size_t face_sensor(PointCloud& cloud, const std::vector<Vec3>& to_sensor) {
  std::size_t turned = 0;
  for (std::size_t i = 0; i < cloud.normals.size(); ++i) {
    const double facing = cloud.normals[i].dot(to_sensor[i]);
    if (facing >= 0) continue;
    cloud.normals[i] = -cloud.normals[i];
    turned += facing < -0.5 ? 1 : 0;
  }
  return turned;
}

}  // namespace hapsim
