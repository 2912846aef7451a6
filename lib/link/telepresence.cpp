#include "link/telepresence.h"

#include <algorithm>
#include <cmath>

#include "estimate/lag.h"
#include "realtime/real_time.h"

namespace hapsim {
namespace {

constexpr std::size_t kRing = 4096;    // motions that may be on their way
constexpr double kLetIn = 0.99;        // share from which the identified body is what is felt
constexpr double kLongestPause = 0.1;  // between two motions that counts as time of the motion [s]

double seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

Teleoperator::Teleoperator(ToolLoop& body, const SafetyLimits& limits, const Vec3& low,
                           const Vec3& high)
    : body_(body),
      limits_(limits),
      low_(low),
      high_(high),
      size_((high - low).norm()),
      motion_(of_motion(limits, size_)),
      force_(of_any_energy(limits)) {}

bool Teleoperator::is_possible(const Packet& motion) const noexcept {
  const Vec3 off = motion.first - motion.first.cwiseMax(low_).cwiseMin(high_);
  return off.norm() <= size_ && (motion.in_air || motion.second.norm() <= size_) &&
         limits_.contains(motion.first + motion.second);
}

void Teleoperator::restart(const Packet& motion) noexcept {
  body_.begin(motion.first);
  const long losses = motion_.losses();
  motion_ = SafeForce(of_motion(limits_, size_));
  motion_.count_losses(losses);
  press_ = motion.press;
  u_.setZero();
  pressing_ = false;
}

bool Teleoperator::press(std::int64_t now, const Received& received, Packet& answer) noexcept {
  const Packet& motion = received.packet;
  if (received.is_anew) last_ = 0;
  if (!received.is_newest || motion.number <= last_) return false;
  last_ = motion.number;
  // Rates are of the motion's own time, for a network bunches packets; a clock that was set, or a
  // pause, counts as little. What was missed counts by this side's clock: idle().
  clock_ += std::clamp(motion.t - t_, 0.0, kLongestPause);
  t_ = motion.t;
  heard_ = now;
  heard_clock_ = clock_;
  answer = {};
  answer.kind = Packet::Kind::kForce;
  answer.number = ++sent_;
  answer.press = motion.press;
  answer.in_air = motion.in_air;
  answer.answers = motion.number;
  answer.t = motion.t;
  SafeSample force;
  if (is_possible(motion)) {
    if (received.is_anew || motion.press != press_) restart(motion);
    const SafeSample made = motion_.pass(clock_, Vec3::Zero(), motion.second);
    const Vec3 u = motion.in_air ? motion.second : made.force;
    energy_ -= felt_.dot(u - u_);
    u_ = u;
    pressing_ = !motion.in_air;
    const Vec3 asked = body_.press(motion.t, u, motion.in_air);
    force = force_.pass(clock_, motion.first + u, asked);
    if (made.flags != 0) force.flags |= kSafeRate;
  } else {
    ++impossible_;
    force = force_.miss(clock_);
    force.flags |= kSafeInvalid;
  }
  felt_ = force.force;
  answer.first = force.force;
  answer.second = force.unlimited;
  answer.flags = force.flags;
  answer.energy = energy_;
  return true;
}

void Teleoperator::idle(std::int64_t now) noexcept {
  const double silent = seconds(now - heard_);
  if (!pressing_ || silent <= limits_.hold) return;
  clock_ = std::max(clock_, heard_clock_ + silent);
  u_ = motion_.miss(clock_).force;
  force_.miss(clock_);
  const bool out = u_ == Vec3::Zero();
  felt_ = body_.press(t_ + silent, u_, out);
  pressing_ = !out;
}

bool Teleoperator::farewell(Packet& answer) noexcept {
  if (last_ == 0) return false;
  answer = {};
  answer.kind = Packet::Kind::kForce;
  answer.number = ++sent_;
  answer.press = press_;
  answer.answers = last_;
  answer.t = t_;
  answer.flags = kSafeEnded;
  answer.energy = energy_;
  return true;
}

Operator::Operator(UnitResponse& body, const OperatorOptions& options)
    : body_(body),
      options_(options),
      safe_(options.limits, 1 / options.rate),
      identification_(static_cast<int>(body.unit_forces().cols()),
                      options.memory > 0 ? options.memory * options.rate
                                         : std::numeric_limits<double>::infinity()),
      moduli_(ModuliVector::Zero(body.unit_forces().cols())),
      ring_(kRing),
      record_(static_cast<std::size_t>(options.remember * options.rate)) {
  for (Sent& sent : ring_) sent.unit = UnitForces::Zero(3, body.unit_forces().cols());
}

Packet Operator::move(std::int64_t now, const MotionLine& line) noexcept {
  if (line.press != press_) {
    body_.begin(line.point);
    press_began_ = sent_ + 1;
    safe_.begin_press();
    forget_measured();
  }
  press_ = line.press;
  const double dt = record_.size() == 0 ? 0 : 1 / options_.rate;
  if (predicts()) {
    const double let_in = 1 - std::exp(-dt / options_.blend);
    moduli_ += let_in * (estimate_.moduli - moduli_);
    share_ += let_in * (1 - share_);
    body_.set_moduli(moduli_);
    // What the late forces owe is no matter of the body that is felt from here on.
    if (share_ > kLetIn && !is_forgiven_) {
      safe_.forgive();
      is_forgiven_ = true;
    }
  }
  const Vec3 predicted = body_.press(line.t, line.u, line.in_air);
  const Vec3 wanted =
      left_ ? Vec3(Vec3::Zero()) : Vec3(share_ * predicted + (1 - share_) * measured_);
  const Vec3 place = line.point + line.u;
  if (record_.size() > 0) energy_ -= felt_.force.dot(place - place_);
  place_ = place;
  felt_ = heard_any_ ? safe_.pass(seconds(now), place, wanted, seconds(heard_))
                     : safe_.miss(seconds(now));
  most_given_ = std::max(most_given_, -safe_.energy().reserve());
  Packet packet;
  packet.kind = Packet::Kind::kMotion;
  packet.number = ++sent_;
  packet.press = line.press;
  packet.in_air = line.in_air;
  packet.t = line.t;
  packet.first = line.point;
  packet.second = line.u;
  packet.energy = energy_;
  Sent& sent = ring_[sent_ % kRing];
  sent.number = sent_;
  sent.unit = body_.unit_forces();
  FeltSample sample;
  sample.t = line.t;
  sample.depth = line.u.norm();
  sample.felt = felt_.force;
  sample.predicted = predicted;
  sample.in_air = line.in_air;
  record_.push(sample);
  const double end = static_cast<double>(record_.size()) / options_.rate;
  if (end >= next_) identify();
  return packet;
}

const SafeSample& Operator::miss(std::int64_t now) noexcept {
  return felt_ = safe_.miss(seconds(now));
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

void Operator::receive(std::int64_t now, const Received& received) noexcept {
  const Packet& force = received.packet;
  if (force.answers > sent_) return;  // of another operator's session before this one
  heard_ = now;
  heard_any_ = true;
  energy_there_ = force.energy;
  if (received.is_anew) {
    newest_ = 0;
    left_ = false;
  }
  if ((force.flags & kSafeEnded) != 0) {
    left_ = true;
    forget_measured();
    return;
  }
  const std::uint64_t index = force.answers - 1;
  const bool whole = (force.flags & kSafeInvalid) == 0;
  if (record_.has(index) && !record_[index].answered) {
    FeltSample& sample = record_[index];
    sample.answered = true;
    sample.actual = force.first;
    ++answered_;
    // What was cut there says nothing of the body.
    const Sent& sent = ring_[force.answers % kRing];
    if (sent.number == force.answers && !force.in_air && force.flags == 0)
      identification_.add(sent.unit, force.first);
  }
  // Overtaken, or of another press: of use to the model, not to the hand.
  if (force.number <= newest_ || force.answers < press_began_) return;
  newest_ = force.number;
  if (!whole) return;
  measured_ = force.first;
  measured_at_ = force.t;
}

void Operator::forget_measured() noexcept {
  measured_.setZero();
  measured_at_ = std::numeric_limits<double>::quiet_NaN();
}

FeltQuality felt_quality(const FeltRecord& record, std::size_t from, std::size_t to, double rate) {
  FeltQuality q;
  from = std::max(from, record.first());
  std::vector<double> depth, felt, actual;
  double squares = 0;
  // The body's force where no answer came: straight between those that did.
  std::vector<std::size_t> answered;
  for (std::size_t i = from; i < std::min(to, record.size()); ++i)
    if (record[i].answered) answered.push_back(i);
  std::size_t next = 0;
  for (std::size_t i = from; i < std::min(to, record.size()) && !answered.empty(); ++i) {
    const FeltSample& s = record[i];
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
