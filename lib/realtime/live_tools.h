// Motions of several tools in, forces and torques out at once.
#pragma once

#include <ostream>

#include "realtime/live_session.h"
#include "realtime/tool_source.h"

namespace hapsim {

// run_live() for SeveralTools: every step is answered and flushed before the next is read.
void run_live_tools(ToolSource& in, std::ostream& out, SeveralTools& tools,
                    const LiveOptions& options, LiveReport& report);

}  // namespace hapsim
