// The answer of a tool as its summary: on the screen, and by --json.
#pragma once

#include "cli/shared_flags.h"
#include "cli/tell.h"
#include "io/stream.h"

namespace hapsim {

inline Option answer_option(const std::string& group = "") {
  return {.flag = flag::json,
          .value = "FILE",
          .help = "Writes what is said at the end as JSON: verdict, numbers, notes, next command.",
          .group = group,
          .writes = {"json"}};
}

// For people on standard error, and for programs where --json asks for it.
inline void tell_answer(const Arguments& arguments, const Summary& summary) {
  if (arguments.given(flag::json)) {
    Output json(arguments[flag::json]);
    json.write(summary_json(summary, arguments.tool()));
    json.commit();
  }
  say_summary(arguments, summary);
}

}  // namespace hapsim
