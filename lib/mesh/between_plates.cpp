#include "mesh/between_plates.h"

#include <algorithm>

namespace hapsim {

double height_between_plates(const Surface& body, const Vec3& contact, const Vec3& normal,
                             double radius) {
  constexpr double kRim = 1.02;
  double height = 0;
  for (const Vec3& p : body.vertices) {
    const Vec3 d = p - contact;
    const double up = d.dot(normal);
    if ((d - up * normal).norm() > kRim * radius) return 0;
    height = std::max(height, -up);
  }
  return height;
}

}  // namespace hapsim
