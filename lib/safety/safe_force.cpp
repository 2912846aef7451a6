#include "safety/safe_force.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// Beyond these something is broken, and not strong [N], [m].
constexpr double kImpossibleForce = 1e5, kImpossiblePlace = 10;
// More than this of a pause does not count as time in which a force may change [s].
constexpr double kLongestStep = 0.01;

bool is_possible(const Vec3& v, double most) {
  return std::abs(v.x()) < most && std::abs(v.y()) < most && std::abs(v.z()) < most;
}

// Shortened to `most`, never longer by rounding.
Vec3 shortened(const Vec3& v, double norm, double most) {
  return v * (most / norm * (1 - 4e-16));
}

}  // namespace

// Where the clock has gone on without samples: the force that is at the hand by now.
void SafeForce::settle(double t) noexcept {
  const double silent = t - fresh_;
  if (!begun_ || silent <= limits_.hold) return;
  if (!lost_) {
    lost_ = returning_ = true;
    ++losses_;
    from_ = last_;
  }
  const double left = 1 - (silent - limits_.hold) / limits_.ramp;
  // At the end exactly zero, however the times were rounded.
  last_ = left > 1e-9 ? Vec3(left * from_) : Vec3(Vec3::Zero());
}

SafeSample SafeForce::without(double t, const Vec3& unlimited, int flags) noexcept {
  SafeSample sample;
  sample.unlimited = unlimited;
  sample.flags = flags;
  if (ended_) {
    sample.flags |= kSafeEnded;
    return sample;
  }
  if (begun_ && std::isfinite(t) && t > now_) now_ = t;
  settle(now_);
  sample.force = last_;
  sample.flags |= lost_ || !begun_ ? kSafeRamped : kSafeHeld;
  return sample;
}

SafeSample SafeForce::miss(double t) noexcept {
  return without(t, Vec3::Zero(), 0);
}

SafeSample SafeForce::zero() noexcept {
  ended_ = true;
  last_.setZero();
  return {Vec3::Zero(), Vec3::Zero(), kSafeEnded};
}

SafeSample SafeForce::pass(double t, const Vec3& position, const Vec3& force,
                           double fresh) noexcept {
  if (ended_ || !std::isfinite(t) || !std::isfinite(fresh) ||
      !is_possible(force, kImpossibleForce) || !is_possible(position, kImpossiblePlace)) {
    const bool finite = is_possible(force, std::numeric_limits<double>::infinity());
    return without(t, finite ? force : Vec3::Zero(), kSafeInvalid);
  }
  if (t - fresh > limits_.hold) return without(t, force, 0);
  const double before = now_, placed_before = placed_;
  now_ = begun_ ? std::max(now_, t) : t;
  settle(now_);
  // What has passed since the last sample; of the first, and of one with the time of the last, it
  // is not known.
  const double passed = begun_ ? now_ - before : 0;
  const double dt = passed > 0 ? std::min(passed, kLongestStep) : begun_ ? 0 : period_;

  SafeSample sample;
  sample.unlimited = force;
  Vec3 aim = force;
  if (!limits_.contains(position)) {
    aim.setZero();
    sample.flags |= kSafeOutside;
  }
  if (const double size = aim.norm(); size > limits_.force) {
    aim = shortened(aim, size, limits_.force);
    sample.flags |= kSafeForce;
  }
  if (const double since = now_ - placed_before; begun_ && since > 0) {
    const double power = aim.dot(position - position_) / since;
    if (power > limits_.power) {
      aim *= limits_.power / power;
      sample.flags |= kSafePower;
    }
  }
  const double back = std::min(limits_.rate, limits_.force / limits_.ramp);
  const double slope = returning_ ? back : limits_.rate;
  const Vec3 step = aim - last_;
  if (const double size = step.norm(); size > slope * dt) {
    aim = last_ + shortened(step, size, slope * dt);
    sample.flags |= kSafeRate;
  } else {
    returning_ = false;
  }
  sample.force = last_ = aim;
  position_ = position;
  placed_ = now_;
  fresh_ = begun_ ? std::max(fresh_, std::min(fresh, now_)) : std::min(fresh, now_);
  begun_ = true;
  lost_ = false;
  return sample;
}

}  // namespace hapsim
