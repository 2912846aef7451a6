// A live motion whose forces are for a hand.
#pragma once

#include <ostream>
#include <string>

#include "realtime/motion_feed.h"
#include "safety/hand_watch.h"
#include "safety/safety_words.h"

namespace hapsim {

// Between a motion and the loop that answers it: takes each line as it comes, and says of each
// force what the hand may have of it. Where no line comes for longer than `hold`, or the loop does
// not answer one for so long, answers of its own go out about every millisecond until the force is
// zero (kSafeUnasked). A force that comes later than `hold` is not felt.
class HandSource : public MotionSource {
 public:
  // `input`, of the motion, ends on signals; `out` is where the answers go.
  HandSource(MotionSource& motion, const Input& input, const SafetyLimits& limits,
             std::ostream& out);

  bool has_contact_point() const override { return motion_.has_contact_point(); }
  bool next(MotionLine& line) override;
  // To write a force is to give it.
  void write_force(std::string& buffer, const MotionLine& line, const Vec3& force) const override;
  // The last answer: zero.
  void end();

  bool lost() const { return safe_.lost(); }
  const SafetyCounts& counts() const { return counts_; }

 private:
  void rest();
  void send(SafeSample sample) const;
  void write(std::string& buffer, const SafeSample& sample) const;

  MotionSource& motion_;
  const Input& input_;
  std::ostream& out_;
  Vec3 tip_ = Vec3::Zero();
  // What the hand has felt, and is written by who answers: the loop, or the watch under its lock.
  mutable SafeForce safe_;
  mutable SafetyCounts counts_;
  mutable MotionLine last_;
  mutable Vec3 felt_ = Vec3::Zero();
  mutable double moved_ = 0;  // when the last line was answered [s]
  mutable std::string text_;
  MotionFeed feed_;
  mutable HandWatch watch_;  // after the feed, which takes the signals
};

}  // namespace hapsim
