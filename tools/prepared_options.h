// How the tools that answer at once make a body ready.
#pragma once

#include <memory>
#include <string>

#include "cli/shared_flags.h"
#include "cli/tool.h"
#include "contact/contact_cache.h"
#include "realtime/accuracy_option.h"
#include "realtime/prepared_body.h"

namespace hapsim {

// With the user's cache, so that a second start finds the field; samples are counted in `progress`,
// which must outlive the preparation.
inline PreparedBodyOptions prepared_options(const Arguments& arguments, double tool_radius,
                                            std::shared_ptr<Progress>& progress) {
  PreparedBodyOptions options;
  options.tool_radius = tool_radius;
  options.cache = default_cache_directory();
  options.tolerance = arguments[flag::accuracy];
  // How many it will be is known when they suffice.
  options.progress = [&arguments, &progress](std::size_t) -> std::function<void()> {
    progress = std::make_shared<Progress>(arguments, "samples of the contact stiffness", 0);
    return [&progress] { progress->step(); };
  };
  return options;
}

// What was not reached: told, for forces between samples are that far off.
inline void tell_accuracy(const Arguments& arguments, const char* tool,
                          const StiffnessField& field) {
  if (const std::string words = accuracy_words(field, arguments[flag::accuracy]); !words.empty())
    say(arguments, tool, words);
}

}  // namespace hapsim
