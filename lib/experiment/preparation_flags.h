// How recordings and bodies are prepared, as flags of a command.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/tool.h"
#include "experiment/experiment.h"

namespace hapsim {

std::vector<Option> preparation_flags();

// With the user's cache where no other is asked for.
ExperimentOptions preparation_options(const Arguments& arguments);

// Those of them that were given and that mean something to what comes after, as words of a command:
// " --noise 0.02".
std::string repeated_flags(const Arguments& arguments);

// A recording as the flags want it: with the tool's radius of --tool-radius. `say` is told where
// they contradict it. Error(kBadInput): no radius; no forces, where they are needed.
Recording as_asked(const Arguments& arguments, Recording recording, bool need_forces,
                   const std::function<void(const std::string&)>& say);

}  // namespace hapsim
