// How far a tool has gone through a body.
#pragma once

#include "mesh/signed_distance.h"

namespace hapsim {

// Beyond this share of the body a linear model of it means little; at this one a loop holds.
inline constexpr double kValidShare = 0.5, kHeldShare = 0.9;

// Length of the straight way from a point of the surface along `direction` (unit) until it is
// outside again [m], to 1 %; by steps of the distance to the surface (Hart, The Visual Computer 12,
// 1996). Some twenty queries; allocates and throws nothing.
double way_through(const SignedDistance& body, const Vec3& from, const Vec3& direction) noexcept;

// How much of its way through the body a tool has gone: the lesser of its depth over the thickness
// along the normal and of |u| over the length along u. 1: it comes out on the far side. The lesser,
// for at a rim the body is thin along its normal, and along a bulge a way sideways is soon outside.
class WayThrough {
 public:
  explicit WayThrough(const SignedDistance* body = nullptr) : body_(body) {}
  // The tool touches there; `normal` outward. Nearly where it did, the same is taken for the same.
  void begin(const Vec3& point, const Vec3& normal) noexcept;
  // Displaced by u from there. The second length is asked for from kValidShare of the first on.
  double share(const Vec3& u) noexcept;
  double depth(const Vec3& u) const { return -u.dot(normal_); }

 private:
  const SignedDistance* body_;
  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::Zero(), direction_ = Vec3::Zero();
  double thickness_ = -1, along_ = 0;  // -1: not asked for yet
};

}  // namespace hapsim
