#include "safety/hand_source.h"

#include <poll.h>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

double seconds_now() {
  return 1e-9 * static_cast<double>(monotonic_ns());
}

void wait_for(int event, int ms) {
  pollfd waited{event, POLLIN, 0};
  poll(&waited, 1, ms);
}

}  // namespace

HandSource::HandSource(MotionSource& motion, const Input& input, const SafetyLimits& limits,
                       std::ostream& out)
    : motion_(motion),
      input_(input),
      out_(out),
      safe_(limits),
      feed_(motion, input),
      watch_(
          limits.hold, [this] { return input_.ended_by_signal(); },
          [this] {
            if (felt_ != Vec3::Zero())
              send(input_.ended_by_signal() ? safe_.zero() : safe_.miss(seconds_now()));
          }) {
  wait_for(feed_.event(), 20);  // so that the first lines of a file are not late while it begins
}

bool HandSource::next(MotionLine& line) {
  while (!input_.ended_by_signal()) {
    feed_.clear_event();
    const bool ended = feed_.has_ended();
    if (feed_.take(line)) {
      tip_ = line.point + line.u;
      watch_.asked(monotonic_ns());
      return true;
    }
    if (ended) return false;
    rest();
    wait_for(feed_.event(), 1);
  }
  return false;
}

void HandSource::write_force(std::string& buffer, const MotionLine& line, const Vec3& force) const {
  const double asked = 1e-9 * static_cast<double>(watch_.when_asked());
  const auto lock = watch_.answer();
  moved_ = seconds_now();
  if (line.press != last_.press) safe_.begin_press();
  last_ = line;
  const bool is_late = moved_ - asked > safe_.limits().hold;
  write(buffer, safe_.pass(moved_, tip_, force, is_late ? asked : moved_));
}

void HandSource::end() {
  const auto lock = watch_.answer();
  if (moved_ > 0) send(safe_.zero());
}

void HandSource::rest() {
  if (moved_ > 0 && seconds_now() - moved_ > safe_.limits().hold && felt_ != Vec3::Zero())
    send(safe_.miss(seconds_now()));
}

void HandSource::send(SafeSample sample) const {
  if ((sample.flags & kSafeEnded) == 0) sample.flags |= kSafeUnasked;
  write(text_, sample);
  out_ << text_;
  out_.flush();
}

void HandSource::write(std::string& buffer, const SafeSample& sample) const {
  counts_.add(sample);
  felt_ = sample.force;
  motion_.write_hand_force(buffer, last_, sample.force, sample.flags, sample.unlimited);
}

}  // namespace hapsim
