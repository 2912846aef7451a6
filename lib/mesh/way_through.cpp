#include "mesh/way_through.h"

#include <algorithm>

namespace hapsim {
namespace {

constexpr double kLeastStep = 0.01;  // share of the way gone

}  // namespace

double way_through(const SignedDistance& body, const Vec3& from, const Vec3& direction) noexcept {
  constexpr int kMost = 200;
  constexpr double kFirst = 1e-5;  // [m]
  double way = kFirst;
  int face = -1;
  for (int i = 0; i < kMost; ++i) {
    const SurfaceSide side = body.at(from + way * direction, face);
    if (side.distance >= 0) return std::max(way - side.distance, 0.0);
    face = side.face;
    way += std::max(-side.distance, kLeastStep * way);
  }
  return way;
}

void WayThrough::begin(const Vec3& point, const Vec3& normal) noexcept {
  // A contact that slides asks at every sample.
  const double near = kLeastStep * thickness_;
  if (thickness_ > 0 && (point - point_).squaredNorm() <= near * near &&
      normal.dot(normal_) > 1 - kLeastStep * kLeastStep) {
    return;
  }
  point_ = point;
  normal_ = normal;
  thickness_ = -1;
  direction_.setZero();
}

double WayThrough::share(const Vec3& u) noexcept {
  const double into = depth(u);
  if (body_ == nullptr || !(into > 0)) return 0;
  if (thickness_ < 0) thickness_ = way_through(*body_, point_, -normal_);
  const double share = into / thickness_;
  if (share < kValidShare) return share;
  const Vec3 direction = u.normalized();
  if (direction.dot(direction_) < 0.9999) {  // by more than 0.8 degrees
    direction_ = direction;
    along_ = way_through(*body_, point_, direction);
  }
  return std::min(share, u.norm() / along_);
}

}  // namespace hapsim
