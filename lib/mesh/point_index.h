// Nearest neighbours among points.
#pragma once

#include <memory>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct Neighbour {
  int index = -1;
  double distance = 0;  // [m]
};

// A k-d tree over points, which must outlive it. Queries are thread-safe and their results sorted
// by distance, then index.
class PointIndex {
 public:
  explicit PointIndex(const std::vector<Vec3>& points);
  ~PointIndex();
  // The k nearest points (fewer when there are fewer); a point of the set is its own nearest.
  std::vector<Neighbour> nearest(const Vec3& p, int k) const;
  std::vector<Neighbour> within(const Vec3& p, double radius) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
