// Where a loop's motion comes from and its forces go to, whatever they are written as.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct MotionLine {
  bool has_contact_point = true;  // else `point` is the tool's tip and `u` is zero
  int press = 1;
  double t = 0;               // [s]
  Vec3 point = Vec3::Zero();  // [m]
  Vec3 u = Vec3::Zero();      // [m]
  bool in_air = false;
  double temperature = std::numeric_limits<double>::quiet_NaN();  // [degC]; NaN: not known
  int beyond = 0;          // of what answers it: ToolLoop::beyond()
  double uncertainty = 0;  // standard, of the length of its force [N]
};

// What next() promises of a motion, one sample after the other.
class MotionCheck {
 public:
  // `where` it stands is asked for when it is wrong: names take memory.
  void check(const MotionLine& line, const std::function<std::string()>& where);
  // Of presses on a body with these nodes [m]: contact points and displacements of its size.
  void within(const std::vector<Vec3>& nodes);

 private:
  bool first_ = true, bounded_ = false;
  Vec3 low_, high_;
  MotionLine last_;
};

class MotionSource {
 public:
  virtual ~MotionSource() = default;
  virtual bool has_contact_point() const = 0;
  // The next one, false at the end; returns as soon as it is there. Error(kBadInput) with its
  // place: what is no number, time that runs backwards within a press, sizes that mean another
  // unit, a contact point that moves within a press.
  virtual bool next(MotionLine& line) = 0;
  // The bytes that answer it, in place of `buffer`, which keeps its memory from one to the next.
  virtual void write_force(std::string& buffer, const MotionLine& line,
                           const Vec3& force) const = 0;
  // The same for a hand: with why the force is not what was asked for (Safety), and that, where the
  // bytes have a place for it.
  virtual void write_hand_force(std::string& buffer, const MotionLine& line, const Vec3& force,
                                int safety, const Vec3& asked) const {
    static_cast<void>(safety), static_cast<void>(asked);
    write_force(buffer, line, force);
  }
  // From now on next() refuses contact points and displacements that no press of a body with
  // these nodes [m] has.
  void within(const std::vector<Vec3>& nodes) { check_.within(nodes); }

 protected:
  MotionCheck check_;
};

}  // namespace hapsim
