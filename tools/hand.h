// --hand: the forces of a live loop go through the last layer before a hand.
#pragma once

#include <fmt/format.h>
#include <poll.h>

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "cli/tool.h"
#include "realtime/motion_feed.h"
#include "realtime/motion_lines.h"
#include "realtime/real_time.h"
#include "safety/safety_words.h"
#include "safety_options.h"

namespace hapsim {

namespace flag {
inline constexpr SwitchFlag hand{"--hand"};
}  // namespace flag

inline std::vector<Option> hand_flags() {
  std::vector<Option> all{
      {.flag = flag::hand,
       .help = "Live: the forces are for somebody's hand, and go through the limits below; what "
               "was asked for stands beside them (safety, ax, ay, az). See hs-safety(7).",
       .group = "Safety"}};
  for (const Option& option : safety_flags()) all.push_back(option);
  return all;
}

// The limits where --hand is given.
inline std::optional<SafetyLimits> hand_limits(const Arguments& arguments) {
  if (arguments[flag::hand]) return safety_limits(arguments);
  for (const AnyFlag& flag :
       AnyFlags{flag::device, flag::max_force, flag::max_rate, flag::max_power, flag::max_speed,
                flag::max_energy, flag::any_energy, flag::hold, flag::ramp, flag::workspace})
    if (arguments.given(flag))
      fail_usage(flag + " is a limit of --hand", "add --hand, or leave it out");
  return std::nullopt;
}

inline std::vector<std::string> hand_columns(std::vector<std::string> columns) {
  columns.insert(columns.end(), {"safety", "ax", "ay", "az"});
  return columns;
}

// Between a motion and the loop that answers it: takes each line as it comes, and says of each
// force what the hand may have of it. Where no line comes for longer than `hold`, lines of its own
// go out about every millisecond until the force is zero.
class HandSource : public MotionSource {
 public:
  // `input`, of the motion, ends on signals.
  HandSource(MotionSource& motion, const Input& input, const SafetyLimits& limits,
             std::ostream& out)
      : motion_(motion), input_(input), out_(out), safe_(limits), feed_(motion, input) {
    wait(20);  // so that the first lines of a file are not late while the feed begins
  }

  bool has_contact_point() const override { return motion_.has_contact_point(); }
  bool next(MotionLine& line) override {
    while (!input_.ended_by_signal()) {
      feed_.clear_event();
      const bool ended = feed_.has_ended();
      if (feed_.take(line)) {
        tip_ = line.point + line.u;
        return true;
      }
      if (ended) return false;
      rest();
      wait(1);
    }
    return false;
  }
  void write_force(std::string& buffer, const MotionLine& line, const Vec3& force) const override {
    moved_ = now();
    if (line.press != last_.press) safe_.begin_press();
    last_ = line;
    write(buffer, safe_.pass(moved_, tip_, force));
  }
  // The last line: zero.
  void end() {
    if (moved_ > 0) send(safe_.zero());
  }

  bool lost() const { return safe_.lost(); }
  const SafetyCounts& counts() const { return counts_; }

 private:
  void wait(int ms) const {  // for a line
    pollfd waited{feed_.event(), POLLIN, 0};
    poll(&waited, 1, ms);
  }
  static double now() { return 1e-9 * static_cast<double>(monotonic_ns()); }
  void rest() {
    if (moved_ > 0 && now() - moved_ > safe_.limits().hold && felt_ != Vec3::Zero())
      send(safe_.miss(now()));
  }
  void send(const SafeSample& sample) {
    write(text_, sample);
    out_ << text_;
    out_.flush();
  }
  void write(std::string& buffer, const SafeSample& sample) const {
    counts_.add(sample);
    felt_ = sample.force;
    motion_.write_force(buffer, last_, sample.force);
    buffer.pop_back();
    buffer += ',' + std::to_string(sample.flags);
    append_columns(buffer, sample.unlimited);
    buffer += '\n';
  }

  MotionSource& motion_;
  const Input& input_;
  std::ostream& out_;
  std::string text_;
  Vec3 tip_ = Vec3::Zero();
  // What the hand has felt: to write a force is to give it.
  mutable SafeForce safe_;
  mutable SafetyCounts counts_;
  mutable MotionLine last_;
  mutable Vec3 felt_ = Vec3::Zero();
  mutable double moved_ = 0;  // when the last line was answered [s]
  MotionFeed feed_;
};

// How a hand's run went.
struct HandReport {
  SafetyCounts counts;
  bool lost = false;
};

// `answer`(MotionSource&) with the motion itself, or with a hand's; zero is sent whatever ends it.
template <class Answer>
void answer_hand(MotionSource& motion, const Input& input,
                 const std::optional<SafetyLimits>& limits, std::ostream& out, HandReport& report,
                 const Answer& answer) {
  if (!limits) return answer(motion);
  HandSource hand(motion, input, *limits, out);
  const auto end = [&] {
    report.lost = hand.lost();
    hand.end();
    report.counts = hand.counts();
  };
  try {
    answer(hand);
  } catch (const Error&) {
    end();
    throw;
  }
  end();
}

inline void tell_hand(const Arguments& arguments, const std::string& tool,
                      const HandReport& report) {
  if (const std::string cut = report.counts.summary(); !cut.empty())
    say(arguments, tool, "safety: " + cut);
}

// Error(kIo) where the motion was silent at the end.
inline void require_motion(const Input& input, const HandReport& report) {
  if (report.lost)
    fail_io(input.name(), "no motion came any more, and the force had gone to zero",
            "see why it stopped; what was felt is written");
}

}  // namespace hapsim
