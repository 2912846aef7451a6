// The state of a closed loop for people and for programs.
#pragma once

#include <string>

#include "cli/summary.h"
#include "explore/explore.h"

namespace hapsim {

// Whether the goals are reached, what each of them is at, and which presses come next. `file`: the
// motion's; "": standard output.
Summary explore_summary(const Exploration& exploration, const std::string& recording,
                        const std::string& file);

// share/schemas/hs-plan.schema.json (two spaces of indent, a newline at the end).
std::string explore_json(const Exploration& exploration);

}  // namespace hapsim
