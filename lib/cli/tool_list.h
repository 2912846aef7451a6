// hapsim's tools by what they are for.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace hapsim {

struct ListedTool {
  Task task;
  std::string name, summary;
};

std::string task_name(Task task);  // "Task::kModel"

// A heading for each task that has a tool, and below it its tools in the given order; 80 columns.
std::string tool_list(const std::vector<ListedTool>& tools);

}  // namespace hapsim
