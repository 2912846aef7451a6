#include "safety/energy_budget.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// Damping at most so that a device whose moving parts have 40 g is stable with it: half of
// 2 m / period, twice over for the sample by which a velocity is late.
constexpr double kLeastMass = 0.04;
// All of that damping is there once this share of the bound is owed.
constexpr double kFullAt = 0.1;
// Who goes faster does not move, but was put somewhere else [m/s].
constexpr double kImpossibleSpeed = 20;

}  // namespace

EnergyBudget::EnergyBudget(const SafetyLimits& limits, double period)
    : bound_(limits.energy_bound(period)),
      speed_(limits.speed),
      rate_(limits.rate),
      period_(period),
      least_damping_(limits.damping) {}

void EnergyBudget::begin(const Vec3& force) noexcept {
  reserve_ = std::min(reserve_, 0.0);
  strongest_ = force.norm();
  farthest_ = 0;
  has_origin_ = false;
}

void EnergyBudget::move(const Vec3& position, const Vec3& dx, double dt,
                        const Vec3& force) noexcept {
  if (!has_origin_) {
    origin_ = position - dx;
    has_origin_ = true;
  }
  const double way = dx.norm();
  dt = std::max(dt, 0.5 * period_);
  if (way > kImpossibleSpeed * dt) return;
  const double work = force.dot(dx);
  given_ += work;
  strongest_ = std::max(strongest_, force.norm());
  farthest_ = std::max(farthest_, (position - origin_).norm());
  reserve_ = std::min(reserve_ - work + least_damping_ * way * way / dt, strongest_ * farthest_);
}

double EnergyBudget::damping(double speed) const noexcept {
  if (!(reserve_ < 0) || !std::isfinite(bound_)) return 0;
  const double most = kLeastMass / (2 * period_) * std::min(1.0, -reserve_ / (kFullAt * bound_));
  return std::min(most, -reserve_ / (speed * speed * period_));
}

bool EnergyBudget::allows(double size, double share) const noexcept {
  return size * (size / (2 * rate_) + period_) * speed_ <= share * bound_ + reserve_;
}

double EnergyBudget::most_force(double share) const noexcept {
  const double left = share * bound_ + reserve_;
  if (!(left > 0)) return 0;
  const double slow = rate_ * period_;
  return std::sqrt(slow * slow + 2 * rate_ * left / speed_) - slow;
}

}  // namespace hapsim
