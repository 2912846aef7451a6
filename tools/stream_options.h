// What the tools that answer a stream of rows share.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "cli/shared_flags.h"
#include "cli/tool.h"
#include "io/stream.h"
#include "recording/contradictions.h"

namespace hapsim {

// --nu and --times of an on-line identification; `who` begins their help: "Operator".
inline std::vector<Option> online_flags(const std::string& who) {
  return {{.flag = flag::nu,
           .value = "NU",
           .help = who + ": Poisson's ratio of the body that is identified.",
           .group = who,
           .default_text = "0.45",
           .minimum = 0,
           .maximum = 0.499},
          {.flag = flag::times,
           .value = "LIST",
           .help = who + ": relaxation times whose moduli are identified too [s], at most five.",
           .group = who,
           .repeatable = true}};
}

// --tool-radius, or the stream's own [m].
inline double stream_radius(const Arguments& arguments, const Metadata& metadata,
                            const std::string& name) {
  if (arguments.given(flag::tool_radius)) {
    const double given = arguments[flag::tool_radius];
    if (const std::string words = other_radius_words(metadata, given, name); !words.empty())
      say(arguments, words);
    return given;
  }
  const double radius = metadata.number("tool_radius", name).value_or(0);
  if (!(radius > 0))
    fail_input(name, "the motion does not say its tool's radius", "give --tool-radius M [m]");
  return radius;
}

// Answers rows until they end. What was answered stays, before a bad row and after a signal too:
// `finish` writes it.
template <class Answer, class Finish>
void answer_stream(const Arguments& arguments, const std::string& tool, Input& input,
                   const Answer& answer, const Finish& finish) {
  input.end_on_signals();
  try {
    answer();
  } catch (const Error&) {
    finish();
    throw;
  }
  finish();
  if (input.ended_by_signal())
    say(arguments, tool, "ended by a signal; what was answered until then is written");
}

}  // namespace hapsim
