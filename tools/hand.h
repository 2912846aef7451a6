// --hand: the forces of a live loop go through the last layer before a hand.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "cli/tool.h"
#include "safety/hand_source.h"
#include "safety/hand_tools.h"
#include "safety/safety_options.h"
#include "safety/safety_words.h"

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

// How a hand's run went.
struct HandReport {
  SafetyCounts counts;
  bool lost = false;
};

// `answer`(source) with the motion itself, or with a hand's (HandSource of MotionSource, HandTools
// of ToolSource); zero is sent whatever ends it.
template <class Hand, class Source, class Answer>
void answer_hand(Source& motion, const Input& input, const std::optional<SafetyLimits>& limits,
                 std::ostream& out, HandReport& report, const Answer& answer) {
  if (!limits) return answer(motion);
  Hand hand(motion, input, *limits, out);
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
