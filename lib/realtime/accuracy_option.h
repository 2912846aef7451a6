// How finely a body is made ready, as a flag of the commands that answer at once.
#pragma once

#include <fmt/format.h>

#include <string>

#include "cli/shared_flags.h"
#include "cli/tool.h"
#include "realtime/stiffness_field.h"

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

// That the samples do not reach what was asked; "" where they do.
inline std::string accuracy_words(const StiffnessField& field, double asked) {
  if (field.expected_error() <= asked) return "";
  return fmt::format(
      "between the {} samples of the contact stiffness that were taken forces are {:.1f} % "
      "off by what is expected, not the {:g} % of --accuracy",
      field.samples(), 100 * field.expected_error(), 100 * asked);
}

}  // namespace hapsim
