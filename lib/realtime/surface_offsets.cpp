#include "realtime/surface_offsets.h"

#include <cmath>

#include "realtime/curved_face.h"

namespace hapsim {
namespace {

constexpr double kApart = 1e-3;         // points nearer to a known one than this tell nothing [m]
constexpr std::size_t kMostSeen = 400;  // then every new one takes the place of the oldest

}  // namespace

void SurfaceOffsets::add(const Vec3& contact) {
  for (const auto& [point, offset] : seen_)
    if ((point - contact).norm() < kApart) return;
  add(contact, surface_->at(contact).distance);
}

void SurfaceOffsets::add(const Vec3& place, double offset) {
  if (seen_.size() == kMostSeen) seen_.erase(seen_.begin());
  const SurfaceSide side = surface_->at(place);
  Vec3 normal;
  seen_.emplace_back(place, offset - curved_height(*surface_, side.face, side.point, normal));
}

double SurfaceOffsets::interpolated(const Vec3& place, std::size_t without) const {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (i == without) continue;
    const double squared = (seen_[i].first - place).squaredNorm() + kApart * kApart;
    const double weight = 1 / (squared * std::sqrt(squared));
    sum += weight * seen_[i].second;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

double SurfaceOffsets::at(const Vec3& point, Vec3& normal) const {
  const SurfaceSide side = surface_->at(point);
  return curved_height(*surface_, side.face, side.point, normal) +
         interpolated(side.point, seen_.size());
}

double SurfaceOffsets::uncertainty() const {
  double squares = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    squares += std::pow(seen_[i].second - interpolated(seen_[i].first, i), 2);
  return seen_.empty() ? 0 : std::sqrt(squares / static_cast<double>(seen_.size()));
}

}  // namespace hapsim
