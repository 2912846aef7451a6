#include "link/telepresence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "estimate/lag.h"
#include "realtime/real_time.h"

namespace hapsim {
namespace {

constexpr std::size_t kRing = 4096;  // motions that may be on their way

}  // namespace

std::string PacketCounts::summary() const {
  return fmt::format("{} taken, {} stale, {} foreign, {} malformed, {}", taken, stale, foreign,
                     malformed, counted(peers, "peer", "peers"));
}

bool Teleoperator::receive(std::int64_t now, std::span<const unsigned char> bytes,
                           Packet& answer) noexcept {
  Packet motion;
  const PacketFault fault = read_packet(bytes, motion);
  if (fault == PacketFault::kMalformed) return ++counts_.malformed, false;
  if (fault == PacketFault::kForeign || motion.kind != Packet::Kind::kMotion)
    return ++counts_.foreign, false;
  const bool anew = motion.sender != operator_;
  if (anew) {
    if (counts_.peers > 0 && now - heard_ < kSilence) return ++counts_.foreign, false;
    operator_ = motion.sender;
    last_ = 0;
    ++counts_.peers;
  }
  if (motion.number <= last_) return ++counts_.stale, false;
  last_ = motion.number;
  heard_ = now;
  ++counts_.taken;
  if (anew || motion.press != press_) body_.begin(motion.first);
  press_ = motion.press;
  answer = {};
  answer.kind = Packet::Kind::kForce;
  answer.sender = sender_;
  answer.number = ++sent_;
  answer.press = motion.press;
  answer.in_air = motion.in_air;
  answer.answers = motion.number;
  answer.t = motion.t;
  answer.first = body_.press(motion.t, motion.second, motion.in_air);
  return true;
}

Operator::Operator(UnitResponse& body, std::uint64_t sender, const OperatorOptions& options,
                   std::size_t expected_samples)
    : body_(body),
      sender_(sender),
      options_(options),
      identification_(static_cast<int>(body.unit_forces().cols()),
                      options.memory > 0 ? options.memory * options.rate
                                         : std::numeric_limits<double>::infinity()),
      moduli_(ModuliVector::Zero(body.unit_forces().cols())),
      ring_(kRing) {
  for (Sent& sent : ring_) sent.unit = UnitForces::Zero(3, body.unit_forces().cols());
  record_.reserve(expected_samples);
}

Packet Operator::move(const MotionLine& line) noexcept {
  if (line.press != press_) body_.begin(line.point);
  press_ = line.press;
  const double dt = record_.empty() ? 0 : 1 / options_.rate;
  if (predicts()) {
    const double let_in = 1 - std::exp(-dt / options_.blend);
    moduli_ += let_in * (estimate_.moduli - moduli_);
    share_ += let_in * (1 - share_);
    body_.set_moduli(moduli_);
  }
  const Vec3 predicted = body_.press(line.t, line.u, line.in_air);
  felt_ = share_ * predicted + (1 - share_) * measured_;
  Packet packet;
  packet.kind = Packet::Kind::kMotion;
  packet.sender = sender_;
  packet.number = ++sent_;
  packet.press = line.press;
  packet.in_air = line.in_air;
  packet.t = line.t;
  packet.first = line.point;
  packet.second = line.u;
  Sent& sent = ring_[sent_ % kRing];
  sent.number = sent_;
  sent.unit = body_.unit_forces();
  Sample sample;
  sample.t = line.t;
  sample.depth = line.u.norm();
  sample.felt = felt_;
  sample.predicted = predicted;
  sample.in_air = line.in_air;
  record_.push_back(sample);
  const double now = static_cast<double>(record_.size()) / options_.rate;
  if (now >= next_) identify();
  return packet;
}

void Operator::identify() noexcept {
  next_ = static_cast<double>(record_.size()) / options_.rate + options_.refresh;
  const std::int64_t start = monotonic_ns();
  const OnlineEstimate found = identification_.estimate();
  longest_ = std::max(longest_, 1e-9 * static_cast<double>(monotonic_ns() - start));
  if (found.samples < options_.samples || !(found.moduli[0] > 0)) return;
  if (!predicts()) {
    identified_ = static_cast<long>(record_.size());
    moduli_ = found.moduli;
  }
  estimate_ = found;
}

void Operator::receive(std::span<const unsigned char> bytes) noexcept {
  Packet force;
  const PacketFault fault = read_packet(bytes, force);
  if (fault == PacketFault::kMalformed) {
    ++counts_.malformed;
    return;
  }
  if (fault == PacketFault::kForeign || force.kind != Packet::Kind::kForce || force.answers == 0 ||
      force.answers > sent_) {
    ++counts_.foreign;
    return;
  }
  if (force.sender != peer_) {  // the teleoperator has come, or come back
    peer_ = force.sender;
    newest_ = 0;
    ++counts_.peers;
  }
  Sample& sample = record_[force.answers - 1];
  if (sample.answered) {
    ++counts_.stale;
    return;
  }
  ++counts_.taken;
  sample.answered = true;
  sample.actual = force.first;
  const Sent& sent = ring_[force.answers % kRing];
  if (sent.number == force.answers && !force.in_air) identification_.add(sent.unit, force.first);
  if (force.number <= newest_) {  // overtaken: of use to the model, no longer to the hand
    ++counts_.stale;
    return;
  }
  newest_ = force.number;
  measured_ = force.first;
}

FeltQuality felt_quality(const std::vector<Operator::Sample>& record, std::size_t from,
                         std::size_t to, double rate) {
  FeltQuality q;
  std::vector<double> depth, felt, actual;
  double squares = 0;
  // The body's force where no answer came: straight between those that did.
  std::vector<std::size_t> answered;
  for (std::size_t i = from; i < std::min(to, record.size()); ++i)
    if (record[i].answered) answered.push_back(i);
  std::size_t next = 0;
  for (std::size_t i = from; i < std::min(to, record.size()) && !answered.empty(); ++i) {
    const Operator::Sample& s = record[i];
    while (next + 1 < answered.size() && answered[next] < i) ++next;
    const std::size_t after = answered[next], before = next > 0 ? answered[next - 1] : after;
    const double share = after > before && i < after
                             ? static_cast<double>(i - before) / static_cast<double>(after - before)
                             : 1;
    const Vec3 force =
        record[before].actual + share * (record[after].actual - record[before].actual);
    depth.push_back(s.in_air ? 0 : s.depth);
    felt.push_back(s.felt.norm());
    actual.push_back(force.norm());
    if (!s.answered || s.in_air) continue;
    squares += (s.felt - s.actual).squaredNorm();
    q.peak = std::max(q.peak, s.actual.norm());
    ++q.samples;
  }
  if (q.samples > 0) q.rms = std::sqrt(squares / (3 * static_cast<double>(q.samples)));
  const int most = static_cast<int>(std::min(rate, 0.4 * static_cast<double>(felt.size())));
  q.lag = lag_between(depth, felt, most) / rate;
  q.force_lag = lag_between(actual, felt, most) / rate;
  return q;
}

}  // namespace hapsim
