// The surface of one zone as its points tell it, for matching others with it.
#pragma once

#include <vector>

#include "mesh/point_index.h"

namespace hapsim {

class ZoneSurface {
 public:
  // At least 6 points.
  explicit ZoneSurface(const std::vector<Vec3>& points);

  // Where the surface lies near p: a quadric over the plane of p's nearest points.
  struct Foot {
    Vec3 normal;      // unit, sign free
    double distance;  // of p along it [m], signed alike
    double blur;      // rms of the neighbours about the quadric [m]
  };
  // False when p lies farther than `reach` [m] off, or beyond the rim of the zone.
  bool foot(const Vec3& p, double reach, Foot& foot) const;
  double spacing() const { return spacing_; }

 private:
  std::vector<Vec3> points_;
  PointIndex index_;
  double spacing_;
};

}  // namespace hapsim
