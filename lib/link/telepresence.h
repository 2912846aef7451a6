// The two ends of a telepresence: who moves and feels, and who presses the real body.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "link/packets.h"
#include "realtime/motion_source.h"
#include "watch/online_identification.h"

namespace hapsim {

// What came in, and what was dropped.
struct PacketCounts {
  long taken = 0;
  long stale = 0;      // older than what is there already, or there already
  long foreign = 0;    // not ours, or of another sender
  long malformed = 0;  // damaged
  long peers = 0;      // senders that were accepted: a peer that returns is one more
  std::string summary() const;
};

// Presses the body by motions and answers each with its force. One operator at a time: another is
// accepted once the first has been silent. Nothing allocates or throws.
class Teleoperator {
 public:
  Teleoperator(ToolLoop& body, std::uint64_t sender) : body_(body), sender_(sender) {}
  // A datagram at time `now` [ns]: whether `answer` is to be sent.
  bool receive(std::int64_t now, std::span<const unsigned char> bytes, Packet& answer) noexcept;
  const PacketCounts& counts() const { return counts_; }
  static constexpr std::int64_t kSilence = 500'000'000;  // [ns]

 private:
  ToolLoop& body_;
  std::uint64_t sender_, operator_ = 0;
  std::int64_t heard_ = 0;
  std::uint32_t last_ = 0, sent_ = 0;
  std::int32_t press_ = std::numeric_limits<std::int32_t>::min();
  PacketCounts counts_;
};

struct OperatorOptions {
  long samples = 500;    // answers in contact from which a model is made
  double refresh = 0.1;  // between two estimates from then on [s]
  double blend = 0.05;   // over which a new estimate is let in [s]
  double memory = 0;     // in which older answers fade [s]; 0: never
  double rate = 1000;    // samples a second
};

// Sends motions, feels the newest force that has come back, gathers both, identifies the body's
// moduli from them (OnlineIdentification) and from then on feels what the identified body answers
// at once (thesis 6.5, Algorithm 6.3). The change is let in without a jump. Nothing allocates once
// it is made, apart from the record where that grows beyond what was reserved.
class Operator {
 public:
  Operator(UnitResponse& body, std::uint64_t sender, const OperatorOptions& options,
           std::size_t expected_samples);

  // The next sample of the motion as a packet; felt() is of it from then on.
  Packet move(const MotionLine& line) noexcept;
  void receive(std::span<const unsigned char> bytes) noexcept;
  const Vec3& felt() const { return felt_; }
  const Vec3& measured() const { return measured_; }  // the newest that has come
  bool predicts() const { return identified_ >= 0; }

  struct Sample {
    double t = 0, depth = 0;  // [s], |u| [m]
    Vec3 felt = Vec3::Zero(), predicted = Vec3::Zero(), actual = Vec3::Zero();
    bool answered = false, in_air = false;
  };
  const std::vector<Sample>& record() const { return record_; }
  long identified_at() const { return identified_; }          // sample, -1: not
  double longest_identification() const { return longest_; }  // [s]
  const OnlineEstimate& estimate() const { return estimate_; }
  const PacketCounts& counts() const { return counts_; }

 private:
  struct Sent {
    std::uint32_t number = 0;
    UnitForces unit;
  };
  void identify() noexcept;

  UnitResponse& body_;
  std::uint64_t sender_, peer_ = 0;
  OperatorOptions options_;
  OnlineIdentification identification_;
  OnlineEstimate estimate_;
  ModuliVector moduli_;
  std::vector<Sent> ring_;
  std::vector<Sample> record_;
  std::uint32_t sent_ = 0, newest_ = 0;
  std::int32_t press_ = std::numeric_limits<std::int32_t>::min();
  Vec3 felt_ = Vec3::Zero(), measured_ = Vec3::Zero();
  double share_ = 0;  // of the prediction in what is felt
  long identified_ = -1;
  double next_ = 0, longest_ = 0;
  PacketCounts counts_;
};

// How what was felt goes with the motion and with the body's own forces, over samples from..to in
// contact.
struct FeltQuality {
  double lag = 0;        // of the felt force behind the displacement [s]
  double force_lag = 0;  // behind the force that the body gave to that very sample [s]
  double rms = 0;        // difference from that force, per component [N]
  double peak = 0;       // of that force [N]
  long samples = 0;      // that were answered
};
FeltQuality felt_quality(const std::vector<Operator::Sample>& record, std::size_t from,
                         std::size_t to, double rate);

}  // namespace hapsim
