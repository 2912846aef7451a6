// How the tools that answer at once make a body ready.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/tool.h"
#include "contact/contact_cache.h"
#include "realtime/prepared_body.h"
#include "shared_flags.h"

namespace hapsim {

inline Option accuracy_option(const std::string& group) {
  return {
      .flag = flag::accuracy,
      .value = "SHARE",
      .help = group +
              ": relative error of the force between samples of the contact stiffness at which "
              "no more are taken, root mean square over the surface; none beyond 1000 of them, and "
              "what was reached by then is said.",
      .group = group,
      .default_text = "0.02",
      .minimum = 0.002,
      .maximum = 1};
}

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
  const double asked = arguments[flag::accuracy];
  if (field.expected_error() <= asked) return;
  say(arguments, tool,
      fmt::format(
          "between the {} samples of the contact stiffness that were taken forces are {:.1f} % "
          "off by what is expected, not the {:g} % of --accuracy",
          field.samples(), 100 * field.expected_error(), 100 * asked));
}

}  // namespace hapsim
