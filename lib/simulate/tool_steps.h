// Several tools in one recording: which rows are one step.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "recording/recording.h"

namespace hapsim {

// Rows of a press, step by step: one a tool in each.
struct ToolSteps {
  std::vector<std::vector<std::size_t>> rows;
  std::size_t tools() const { return rows.front().size(); }
};

// Rows of one press number, of all tools, in order of first appearance.
std::vector<Press> common_presses(const Recording& r);

// The steps of `press`: rows that follow one another with the same time and different values of the
// column `tool_id` are one; without that column each row is one. fail_input (exit code 3) at a step
// with other tools, or contacts more than 0.1 mm from those of the first.
ToolSteps tool_steps(const Recording& r, const Press& press);

// "FILE:LINE" of a row, for messages.
std::string recording_line(const Recording& r, std::size_t row);

}  // namespace hapsim
