#include "recording/contact_points.h"

#include <algorithm>

namespace hapsim {

std::vector<Vec3> contact_points(const Recording& recording) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::vector<Vec3> points = recording.position;
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace hapsim
