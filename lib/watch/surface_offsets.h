// Where the real surface lies off the model's.
#pragma once

#include <utility>
#include <vector>

#include "mesh/signed_distance.h"

namespace hapsim {

// Contact points are on the real surface, the model's mesh cuts corners between its nodes: its
// faces are taken as curved (curved_face.h), and what is left of the points seen is interpolated by
// inverse cubes of the distances.
class SurfaceOffsets {
 public:
  explicit SurfaceOffsets(const SignedDistance& surface) : surface_(&surface) {}
  void add(const Vec3& contact);
  // A place near the surface where the offset is known otherwise.
  void add(const Vec3& place, double offset);
  // Real less model's, along the model's outward normal there [m].
  double at(const Vec3& point, Vec3& normal) const;
  // Root mean square by which a contact point lies off where the others put it [m].
  double uncertainty() const;

 private:
  const SignedDistance* surface_;
  std::vector<std::pair<Vec3, double>> seen_;  // place and what lies there over the curved face
};

}  // namespace hapsim
