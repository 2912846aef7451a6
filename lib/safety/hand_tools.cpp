#include "safety/hand_tools.h"

#include <poll.h>

#include <algorithm>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

double clock_now() {
  return 1e-9 * static_cast<double>(monotonic_ns());
}

void wait_until_ready(int event, int ms) {
  pollfd waited{event, POLLIN, 0};
  poll(&waited, 1, ms);
}

}  // namespace

HandTools::HandTools(ToolSource& motion, const Input& input, const SafetyLimits& limits,
                     std::ostream& out)
    : motion_(motion),
      input_(input),
      out_(out),
      safe_(limits, motion.tools()),
      feed_(motion, input),
      watch_(
          limits.hold, [this] { return input_.ended_by_signal(); },
          [this] {
            if (is_felt()) send(input_.ended_by_signal());
          }) {
  wait_until_ready(feed_.event(), 20);
}

// Where the tools are that have come; the others are where they were.
void HandTools::see(const ToolStep& step, double now) {
  for (std::size_t k = 0; k < tools(); ++k)
    if (step.present[k]) seen_[k] = {step.pose[k].point + step.pose[k].u, step.pose[k].turn, now};
}

bool HandTools::next(ToolStep& step) {
  while (!input_.ended_by_signal()) {
    feed_.clear_event();
    const bool ended = feed_.has_ended();
    if (feed_.take(step)) {
      const std::int64_t now = monotonic_ns();
      see(step, 1e-9 * static_cast<double>(now));
      watch_.asked(now);
      return true;
    }
    if (ended) return false;
    rest();
    wait_until_ready(feed_.event(), 1);
  }
  return false;
}

void HandTools::write(std::string& buffer, const ToolStep& step,
                      std::span<const ToolFeel> feel) const {
  const auto lock = watch_.answer();
  moved_ = clock_now();
  last_ = step;
  std::copy(feel.begin(), feel.end(), felt_.begin());
  for (std::size_t k = 0; k < feel.size(); ++k) {
    const Seen& seen = seen_[k];
    const double hold = safe_.limits().hold;
    if (seen.when > 0)
      safe_.limit(k, moved_, seen.tip, seen.turn, felt_[k],
                  moved_ - seen.when > hold ? seen.when : moved_);
    else
      safe_.miss(k, moved_, felt_[k]);
  }
  tell(buffer);
}

void HandTools::end() {
  const auto lock = watch_.answer();
  if (moved_ > 0) send(true);
}

bool HandTools::is_felt() const {
  return std::any_of(
      felt_.begin(), felt_.begin() + static_cast<std::ptrdiff_t>(tools()),
      [](const ToolFeel& f) { return f.force != Vec3::Zero() || f.torque != Vec3::Zero(); });
}

void HandTools::rest() {
  if (moved_ > 0 && clock_now() - moved_ > safe_.limits().hold && is_felt()) send(false);
}

void HandTools::send(bool ends) const {
  for (std::size_t k = 0; k < tools(); ++k) {
    if (ends) {
      safe_.zero(k, felt_[k]);
    } else {
      safe_.miss(k, clock_now(), felt_[k]);
      felt_[k].safety |= kSafeUnasked;
    }
  }
  if (!ends && !motion_.takes_unasked()) return;
  tell(text_);
  out_ << text_;
  out_.flush();
}

void HandTools::tell(std::string& buffer) const {
  for (std::size_t k = 0; k < tools(); ++k) counts_.add({felt_[k].force, {}, felt_[k].safety});
  motion_.write(buffer, last_, {felt_.data(), tools()});
}

}  // namespace hapsim
