// Several tools in one recording: which rows are one step.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "recording/recording.h"

namespace hapsim {

// Rows of one body in time, step by step: one a touch in each.
struct ToolSteps {
  static constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);  // a touch that rests then
  std::vector<std::vector<std::size_t>> rows;
  std::size_t touches() const { return rows.front().size(); }
  std::vector<std::size_t> first_rows() const;  // one a touch
};

// All rows of a recording. Rows of one press number are one body in time; those that follow one
// another with the same time and different values of the column `tool_id` are one step, the same
// tools in each; without that column each row is one. Where tools press at once, each in presses of
// its own, these are one body in time together, and what a tool does at one place is one touch,
// which rests where it has no row. fail_input (exit code 3) at a step with other tools, or contacts
// more than 0.1 mm from those of the first.
std::vector<ToolSteps> tool_steps(const Recording& r);

// "FILE:LINE" of a row, for messages.
std::string recording_line(const Recording& r, std::size_t row);

}  // namespace hapsim
