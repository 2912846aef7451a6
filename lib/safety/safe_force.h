// The last layer before a hand: what comes out of it is safe whatever goes in.
#pragma once

#include "safety/energy_budget.h"

namespace hapsim {

// Why a force is not what was asked for: bits of SafeSample::flags.
enum Safety : int {
  kSafeForce = 1,     // its size was cut
  kSafeRate = 2,      // its change was cut: too fast, or coming back after a loss
  kSafePower = 4,     // what it does on the hand was cut
  kSafeOutside = 8,   // the tool is outside the workspace
  kSafeInvalid = 16,  // the sample was no number, or beyond all bounds
  kSafeHeld = 32,     // there is no new sample: the last force
  kSafeRamped = 64,   // there has been none for longer: on the way to zero, and zero
  kSafeEnded = 128,   // zero, for good
  kSafeEnergy = 256,  // damped or cut: the hand has got more energy than it has put in
  kSafeUnasked = 512  // sent for want of a motion, or of its answer
};

struct SafeSample {
  Vec3 force = Vec3::Zero();      // [N]
  Vec3 unlimited = Vec3::Zero();  // that was asked for; zero where that was no number
  int flags = 0;                  // Safety; 0: `force` is `unlimited`, bit for bit
};

// For one hand, by its own clock: times t [s] are of one that nobody sets. Of every sample that it
// gives, whatever was asked for:
//   |f| <= force; |f - f_before| <= rate (t - t_before), but for zero() and after a stop;
//   a sample within the limits comes through as it is;
//   without valid samples the force is held for `hold` and then goes to zero on a straight line
//   within `ramp`; after that it comes back no faster than it would have gone, from where it is.
// The power is limited in what is aimed at, which is reached at `rate`. The energy that the hand
// gets is limited as EnergyBudget says; a force that owes none is not touched by that. Nothing
// allocates, throws, locks or asks the system.
class SafeForce {
 public:
  // `period`: what the first sample took, and what a time that does not go on counts [s].
  explicit SafeForce(const SafetyLimits& limits, double period = 1e-3)
      : limits_(limits), period_(period), budget_(limits, period) {}

  // A new force for a tool at `position` [m].
  SafeSample pass(double t, const Vec3& position, const Vec3& force) noexcept {
    return pass(t, position, force, t);
  }
  // One out of what was true at the time `fresh`: of a peer that has not been heard since.
  SafeSample pass(double t, const Vec3& position, const Vec3& force, double fresh) noexcept;
  // The samples from now on are of another press.
  void begin_press() noexcept { budget_.begin(last_); }
  // Forgives the energy that is owed: where forces are another's from now on. The bound is there
  // once more.
  void forgive() noexcept { budget_.forgive(); }
  // None has come.
  SafeSample miss(double t) noexcept;
  // At once, and for ever: the end.
  SafeSample zero() noexcept;

  // Whether it is without valid samples now for longer than `hold`, and how often that has begun.
  bool lost() const { return lost_; }
  long losses() const { return losses_; }
  void count_losses(long losses) { losses_ += losses; }  // of one that this one goes on for
  const SafetyLimits& limits() const { return limits_; }
  const EnergyBudget& energy() const { return budget_; }

 private:
  SafeSample without(double t, const Vec3& unlimited, int flags, const Vec3* position) noexcept;
  void settle(double t) noexcept;
  Vec3 follow(const Vec3& position, const Vec3& given) noexcept;

  SafetyLimits limits_;
  double period_;
  EnergyBudget budget_;
  Vec3 last_ = Vec3::Zero();      // given out
  Vec3 held_ = Vec3::Zero();      // given out when the tool was last seen
  Vec3 from_ = Vec3::Zero();      // where the ramp began
  Vec3 position_ = Vec3::Zero();  // where the tool was last seen
  // Times of the last sample, of where the tool was last seen, and when what was asked was true.
  double now_ = 0, placed_ = 0, fresh_ = 0;
  bool begun_ = false, is_placed_ = false, lost_ = false, returning_ = false, ended_ = false;
  long losses_ = 0;
};

}  // namespace hapsim
