// How much energy a force may still give to a hand: passivity, kept in time.
#pragma once

#include <algorithm>

#include "base/vec3.h"
#include "safety/limits.h"

namespace hapsim {

// Counts the work of a force that is held from one sample to the next, and says what of the next
// one must go so that the hand never gets more than B = SafetyLimits::energy_bound() beyond what it
// has put in. With W(s, t) the work on the hand from s to t [J], at every t:
//   W(0, t) <= B + C(0, t), and since any moment s of the press:  W(s, t) <= B + R + C(s, t);
// C: what the least damping of hand and device (SafetyLimits::damping) has taken; R: the largest
// force times the longest way from where the press began, more than any body can have stored that
// was pressed so. It holds while samples come at least every `period` [s] and
// the hand is no faster than SafetyLimits::speed; a pause of p [s] can add force times speed times
// p.
//
// Observer and damping: Hannaford and Ryu, Time-domain passivity control of haptic interfaces, IEEE
// Trans. Robotics and Automation 18(1), 2002; with a delay the port at the hand is what is kept
// passive, as by Ryu, Artigas and Preusche, Mechatronics 20(7), 2010, against the hand's own work
// and not the far side's, so that an identified body, felt at once, is not damped. The device's
// damping as credit: Colgate and Schenkel, J. Robotic Systems 14(1), 1997. Damping alone bounds
// nothing where forces may change so fast only; so besides
//   |f| (|f| / (2 rate) + period) speed <= B + reserve:
// the force can be taken back, at its rate, before a hand that flees has got what is left. What is
// asked for may use kAsked of B; the rest is for the damping, by which the hand pays what it owes.
class EnergyBudget {
 public:
  EnergyBudget(const SafetyLimits& limits, double period);

  // Another press: what the last one has put in is forgotten, what is owed is not. `force`: now
  // [N].
  void begin(const Vec3& force) noexcept;
  // What is owed is forgiven: the bound holds anew from here.
  void forgive() noexcept { reserve_ = std::max(reserve_, 0.0); }
  // The hand was moved by `dx` [m], to `position`, within `dt` [s] while `force` was on it [N].
  void move(const Vec3& position, const Vec3& dx, double dt, const Vec3& force) noexcept;

  // What hand and damping have put in and not got back [J]; below zero: it is owed.
  double reserve() const { return reserve_; }
  double given() const { return given_; }  // W since the start [J]
  // What damps a hand of that speed [m/s] now [N s/m]: never more than is owed within a period, and
  // zero where nothing is.
  double damping(double speed) const noexcept;
  // Whether a force of that size can be taken back in time, and the largest that can [N], when it
  // may use that `share` of the bound.
  bool allows(double size, double share = 1) const noexcept;
  double most_force(double share = 1) const noexcept;
  static constexpr double kAsked = SafetyLimits::kAskedEnergy;

 private:
  double bound_, speed_, rate_, period_, least_damping_;
  double reserve_ = 0, given_ = 0;
  double strongest_ = 0, farthest_ = 0;  // of this press [N], [m]
  Vec3 origin_ = Vec3::Zero();
  bool has_origin_ = false;
};

}  // namespace hapsim
