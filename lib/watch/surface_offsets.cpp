#include "watch/surface_offsets.h"

#include <cmath>

#include "realtime/curved_face.h"
#include "realtime/inverse_cubes.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostSeen = 400;  // then every new one takes the place of the oldest

}  // namespace

void SurfaceOffsets::add(const Vec3& contact) {
  for (const auto& [point, offset] : seen_)
    if ((point - contact).norm() < kSeenApart) return;
  add(contact, surface_->at(contact).distance);
}

void SurfaceOffsets::add(const Vec3& place, double offset) {
  if (seen_.size() == kMostSeen) seen_.erase(seen_.begin());
  const SurfaceSide side = surface_->at(place);
  Vec3 normal;
  seen_.emplace_back(place, offset - curved_height(*surface_, side.face, side.point, normal));
}

double SurfaceOffsets::at(const Vec3& point, Vec3& normal) const {
  const SurfaceSide side = surface_->at(point);
  return curved_height(*surface_, side.face, side.point, normal) +
         inverse_cubes(seen_, 0.0, side.point);
}

double SurfaceOffsets::uncertainty() const {
  double squares = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    squares += std::pow(seen_[i].second - inverse_cubes(seen_, 0.0, seen_[i].first, i), 2);
  return seen_.empty() ? 0 : std::sqrt(squares / static_cast<double>(seen_.size()));
}

}  // namespace hapsim
