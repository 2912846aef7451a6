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
  const Vec3 falling = left > 1e-9 ? Vec3(left * from_) : Vec3(Vec3::Zero());
  if (falling.squaredNorm() < last_.squaredNorm()) last_ = falling;  // it may have been cut since
}

// The tool is at `position` now, with `given` as the last sample: counts the work since it was last
// seen. Its velocity [m/s].
Vec3 SafeForce::follow(const Vec3& position, const Vec3& given) noexcept {
  Vec3 velocity = Vec3::Zero();
  if (is_placed_) {
    const Vec3 dx = position - position_;
    const double since = now_ - placed_;
    // Where the force fell meanwhile, nobody knows when the hand moved: by the worse of the two.
    budget_.move(position, dx, since, held_.dot(dx) > given.dot(dx) ? held_ : given);
    if (since > 0) velocity = dx / std::max(since, 0.5 * period_);
  }
  is_placed_ = true;
  position_ = position;
  placed_ = now_;
  return velocity;
}

SafeSample SafeForce::without(double t, const Vec3& unlimited, int flags,
                              const Vec3* position) noexcept {
  SafeSample sample;
  sample.unlimited = unlimited;
  sample.flags = flags;
  if (ended_) {
    sample.flags |= kSafeEnded;
    return sample;
  }
  const double before = now_;
  const Vec3 given = last_;
  if (begun_ && std::isfinite(t) && t > now_) now_ = t;
  settle(now_);
  if (begun_ && position != nullptr) {
    follow(*position, given);
    if (const double size = last_.norm(); !budget_.allows(size)) {
      const double slowest = given.norm() - limits_.rate * (now_ - before);
      const double most = std::max(budget_.most_force(), slowest);
      if (most < size) {
        last_ = shortened(last_, size, most);
        sample.flags |= kSafeEnergy;
      }
    }
    held_ = last_;
  }
  sample.force = last_;
  sample.flags |= lost_ || !begun_ ? kSafeRamped : kSafeHeld;
  return sample;
}

SafeSample SafeForce::miss(double t) noexcept {
  return without(t, Vec3::Zero(), 0, nullptr);
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
    const bool is_somewhere = std::isfinite(t) && is_possible(position, kImpossiblePlace);
    return without(t, finite ? force : Vec3::Zero(), kSafeInvalid,
                   is_somewhere ? &position : nullptr);
  }
  if (t - fresh > limits_.hold) return without(t, force, 0, &position);
  const double before = now_;
  const Vec3 given = last_;
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
  const Vec3 velocity = follow(position, given);
  if (const double power = aim.dot(velocity); power > limits_.power) {
    aim *= limits_.power / power;
    sample.flags |= kSafePower;
  }
  if (!budget_.allows(limits_.force, EnergyBudget::kAsked)) {
    const double most = budget_.most_force(EnergyBudget::kAsked);
    if (const double size = aim.norm(); size > most) {
      aim = shortened(aim, size, most);
      sample.flags |= kSafeEnergy;
    }
  }
  if (const double damping = budget_.damping(velocity.norm()); damping > 0) {
    Vec3 damped = aim - damping * velocity;
    if (const double size = damped.norm(); size > limits_.force)
      damped = shortened(damped, size, limits_.force);
    if (damped != aim) sample.flags |= kSafeEnergy;
    aim = damped;
  }
  // First down to what the energy allows, then, with what silence and that left of the rate, to the
  // aim.
  Vec3 from = last_;
  const double back = std::min(limits_.rate, limits_.force / limits_.ramp);
  if (!budget_.allows(limits_.force)) {
    const double most = budget_.most_force();
    if (const double size = aim.norm(); size > most) {
      aim = shortened(aim, size, most);
      sample.flags |= kSafeEnergy;
    }
    if (const double size = from.norm(); size > most) {
      const double less = std::min(size - most, limits_.rate * dt);
      from = shortened(from, size, size - less);
      sample.flags |= kSafeEnergy;
    }
  }
  const double left = std::max(limits_.rate * dt - (given - from).norm(), 0.0);
  const double room = std::min((returning_ ? back : limits_.rate) * dt, left);
  const Vec3 step = aim - from;
  if (const double size = step.norm(); size > room) {
    aim = from + shortened(step, size, room);
    sample.flags |= kSafeRate;
  } else {
    returning_ = false;
  }
  sample.force = last_ = held_ = aim;
  fresh_ = begun_ ? std::max(fresh_, std::min(fresh, now_)) : std::min(fresh, now_);
  begun_ = true;
  lost_ = false;
  return sample;
}

}  // namespace hapsim
