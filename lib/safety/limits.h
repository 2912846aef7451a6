// What a force at somebody's hand may be at most.
#pragma once

#include <limits>

#include "base/vec3.h"
#include "io/stream.h"

namespace hapsim {

// Careful values for a desktop device and a hand that rests on it. hs-safety(7) says where they
// come from, and what they cannot know.
struct SafetyLimits {
  double force = 10;   // size [N]
  double rate = 1000;  // of its change [N/s]; `force` must not fall to zero faster within `ramp`
  double power = 10;   // that the force may do on the hand, force times velocity [W]
  double speed = 1;    // of a tool that is led by somebody far away, and of a hand [m/s]
  double hold = 0.1;   // how long a force goes on without a new sample [s]
  double ramp = 0.2;   // then it goes to zero within [s]
  // That the force may give to the hand beyond what the hand has put in [J]; zero: what its limits
  // make inevitable, infinity: any. See EnergyBudget.
  double energy = 0;
  double damping = 1;  // that hand and device have at least [N s/m]
  // A torque counts as its force at this lever, half the breadth of a grip [m]: 0.3 N m.
  double lever = 0.03;
  // Where the tool may be [m]; outside, the force goes to zero.
  Vec3 low = Vec3::Constant(-std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(std::numeric_limits<double>::infinity());

  // With `period` [s] between two samples: from `force` to zero at `rate`, a sample late, while a
  // hand flees at `speed`; and a quarter of it for damping.
  double energy_bound(double period = 1e-3) const {
    return energy > 0 ? energy : force * (force / (2 * rate) + period) * speed / kAskedEnergy;
  }
  static constexpr double kAskedEnergy = 0.8;
  bool contains(const Vec3& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
};

// Error(kUsage) in one line where they make no sense together: none positive, `force` over `ramp`
// steeper than `rate`, a workspace without inside.
void check(const SafetyLimits& limits);

// A device file: CSV with the columns limit and value, rows force, rate, power, speed, hold, ramp,
// energy, damping, lever, x_low, x_high, ... z_high in SI; what it does not name stays as in
// `limits`. Error(kBadInput).
SafetyLimits read_limits(Input& input, SafetyLimits limits = {});

// The same for the motion of a tool that somebody far away leads: a displacement of at most `size`
// [m] that changes with at most `speed`, is held and then taken back where nothing more is heard.
inline SafetyLimits of_motion(const SafetyLimits& limits, double size) {
  SafetyLimits motion = limits;
  motion.force = size;
  motion.rate = limits.speed;
  motion.power = motion.energy = std::numeric_limits<double>::infinity();
  return motion;
}

// The same for a torque divided by `lever`, at the tool's rotation vector times it.
inline SafetyLimits of_torque(SafetyLimits limits) {
  limits.low = SafetyLimits().low;
  limits.high = SafetyLimits().high;
  return limits;
}

// The same limits where energy is not counted: of forces that no hand feels.
inline SafetyLimits of_any_energy(SafetyLimits limits) {
  limits.energy = std::numeric_limits<double>::infinity();
  return limits;
}

}  // namespace hapsim
