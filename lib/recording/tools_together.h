// Recordings of several tools at once: a column tool_id.
#pragma once

#include <string>

#include "recording/recording.h"

namespace hapsim {

// The column tool_id of a recording, one entry a row; null: one tool.
const std::vector<std::string>* tool_ids(const Recording& r);

// What is to be said to whom takes each tool's press by itself, though in some rows another tool
// presses at the same time; "" where there are none.
std::string tools_together(const Recording& r);

}  // namespace hapsim
