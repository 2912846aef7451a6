// How a tool tells what it has found.
#pragma once

#include "cli/summary.h"
#include "cli/tool.h"

namespace hapsim {

// On standard error, unless --quiet; the verdict in colour on a terminal. Says where the result
// goes when a terminal was not given it.
void say_summary(const Arguments& arguments, const Summary& summary);

}  // namespace hapsim
