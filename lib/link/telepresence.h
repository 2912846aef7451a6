// The two ends of a telepresence: who moves and feels, and who presses the real body.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "link/ends.h"
#include "realtime/motion_source.h"
#include "safety/safe_force.h"
#include "watch/online_identification.h"

namespace hapsim {

// Presses the body by motions and answers each with its force, both within the limits: motions
// that no press of this body has are not made, the tool goes no faster than `speed`, and where no
// motion comes any more it is held and then taken back. Nothing allocates or throws.
class Teleoperator {
 public:
  // `low`, `high`: corners of the body's box [m].
  Teleoperator(ToolLoop& body, const SafetyLimits& limits, const Vec3& low, const Vec3& high);
  // A motion that has come at time `now` [ns] of a clock that nobody sets; false: it is old.
  bool press(std::int64_t now, const Received& motion, Packet& answer) noexcept;
  // Nothing has: to be called every few milliseconds.
  void idle(std::int64_t now) noexcept;
  // The last answer: zero, for good. False where there has been no motion.
  bool farewell(Packet& answer) noexcept;

  long impossible() const { return impossible_; }  // motions that were not made
  long losses() const { return motion_.losses(); }
  const Vec3& displacement() const { return u_; }  // of the tool now [m]

 private:
  bool is_possible(const Packet& motion) const noexcept;
  void restart(const Packet& motion) noexcept;

  ToolLoop& body_;
  SafetyLimits limits_;
  Vec3 low_, high_;
  double size_;
  SafeForce motion_, force_;
  std::uint64_t last_ = 0, sent_ = 0;
  std::int32_t press_ = std::numeric_limits<std::int32_t>::min();
  bool pressing_ = false;
  double clock_ = 0, t_ = 0;  // own, of what has passed in the motions [s]; the last motion's
  std::int64_t heard_ = 0;    // [ns]
  double heard_clock_ = 0, energy_ = 0;
  Vec3 u_ = Vec3::Zero(), felt_ = Vec3::Zero();
  long impossible_ = 0;
};

struct OperatorOptions {
  long samples = 500;     // answers in contact from which a model is made
  double refresh = 0.1;   // between two estimates from then on [s]
  double blend = 0.05;    // over which a new estimate is let in [s]
  double memory = 0;      // in which older answers fade [s]; 0: never
  double rate = 1000;     // samples a second
  double remember = 120;  // so long a record is kept [s]
  SafetyLimits limits;
};

// What was sent and felt, the last so many samples, by their numbers from 0. All memory is taken at
// the start.
struct FeltSample {
  double t = 0, depth = 0;  // [s], |u| [m]
  Vec3 felt = Vec3::Zero(), predicted = Vec3::Zero(), actual = Vec3::Zero();
  bool answered = false, in_air = false;
};
class FeltRecord {
 public:
  explicit FeltRecord(std::size_t capacity) : samples_(std::max<std::size_t>(capacity, 1)) {}
  std::size_t size() const { return size_; }  // ever
  std::size_t first() const { return size_ > samples_.size() ? size_ - samples_.size() : 0; }
  bool has(std::size_t i) const { return i >= first() && i < size_; }
  const FeltSample& operator[](std::size_t i) const { return samples_[i % samples_.size()]; }
  FeltSample& operator[](std::size_t i) { return samples_[i % samples_.size()]; }
  void push(const FeltSample& sample) { samples_[size_++ % samples_.size()] = sample; }

 private:
  std::vector<FeltSample> samples_;
  std::size_t size_ = 0;
};

// Sends motions, feels the newest force that has come back, gathers both, identifies the body's
// moduli from them (OnlineIdentification) and from then on feels what the identified body answers
// at once (thesis 6.5, Algorithm 6.3). The change is let in without a jump. What the hand gets has
// gone through SafeForce: without forces from the teleoperator it goes to zero, identified or not.
// Late forces are active; the energy that they give has SafeForce's bound. Once the identified body
// alone is felt, what they owe is forgiven, one time: so over a session the bound is twice that.
// Nothing allocates once it is made.
class Operator {
 public:
  Operator(UnitResponse& body, const OperatorOptions& options);

  // The next sample of the motion at time `now` [ns] as a packet; felt() is of it from then on.
  Packet move(std::int64_t now, const MotionLine& line) noexcept;
  void receive(std::int64_t now, const Received& force) noexcept;
  // No motion has come: what the hand gets meanwhile.
  const SafeSample& miss(std::int64_t now) noexcept;
  // The end, by a signal: zero.
  const SafeSample& end() noexcept { return felt_ = safe_.zero(); }

  const SafeSample& felt() const { return felt_; }
  const SafetyLimits& limits() const { return safe_.limits(); }
  const Vec3& measured() const { return measured_; }  // the newest that has come of this press
  double measured_at() const {
    return measured_at_;
  }  // time of the sample it answers [s], NaN: none
  bool predicts() const { return identified_ >= 0; }
  // Whether forces have come, and stopped coming.
  bool lost() const { return safe_.lost() || left_; }
  long losses() const { return safe_.losses(); }

  const FeltRecord& record() const { return record_; }
  long identified_at() const { return identified_; }          // sample, -1: not
  double longest_identification() const { return longest_; }  // [s]
  const OnlineEstimate& estimate() const { return estimate_; }
  long answered() const { return answered_; }
  // Energy that the hand has put in, and the peer's body has taken, as far as is known [J].
  double energy_in() const { return energy_; }
  double energy_there() const { return energy_there_; }
  // How far the hand was ever ahead: what it got more than it, and its least damping, had put in
  // since a press began [J].
  double most_given() const { return most_given_; }
  double period() const { return 1 / options_.rate; }

 private:
  struct Sent {
    std::uint64_t number = 0;
    UnitForces unit;
  };
  void identify() noexcept;
  void forget_measured() noexcept;

  UnitResponse& body_;
  OperatorOptions options_;
  SafeForce safe_;
  SafeSample felt_;
  OnlineIdentification identification_;
  OnlineEstimate estimate_;
  ModuliVector moduli_;
  std::vector<Sent> ring_;
  FeltRecord record_;
  std::uint64_t sent_ = 0, newest_ = 0, press_began_ = 0;
  std::int32_t press_ = std::numeric_limits<std::int32_t>::min();
  Vec3 measured_ = Vec3::Zero(), place_ = Vec3::Zero();
  double measured_at_ = std::numeric_limits<double>::quiet_NaN();
  std::int64_t heard_ = 0;
  bool heard_any_ = false, left_ = false;  // left: the teleoperator has said that it ends
  double share_ = 0;                       // of the prediction in what is felt
  bool is_forgiven_ = false;               // what late forces owed, once
  long identified_ = -1, answered_ = 0;
  double next_ = 0, longest_ = 0, energy_ = 0, energy_there_ = 0;
  double most_given_ = 0;
};

// How what was felt goes with the motion and with the body's own forces, over samples from..to in
// contact, as far as they are still known.
struct FeltQuality {
  double lag = 0;        // of the felt force behind the displacement [s]
  double force_lag = 0;  // behind the force that the body gave to that very sample [s]
  double rms = 0;        // difference from that force, per component [N]
  double peak = 0;       // of that force [N]
  long samples = 0;      // that were answered
};
FeltQuality felt_quality(const FeltRecord& record, std::size_t from, std::size_t to, double rate);

}  // namespace hapsim
