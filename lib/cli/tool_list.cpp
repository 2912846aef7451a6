#include "cli/tool_list.h"

#include <algorithm>

#include "cli/wrap.h"

namespace hapsim {
namespace {

struct TaskWords {
  Task task;
  const char* name;
  const char* title;
};
constexpr TaskWords kTasks[] = {{Task::kBody, "kBody", "From a scan to a body"},
                                {Task::kRecording, "kRecording", "Recordings"},
                                {Task::kModel, "kModel", "A model, and what it lacks"},
                                {Task::kForces, "kForces", "Forces of a model"},
                                {Task::kMany, "kMany", "Many recordings, and checks"}};

}  // namespace

std::string task_name(Task task) {
  for (const TaskWords& t : kTasks)
    if (t.task == task) return std::string("Task::") + t.name;
  return "";
}

std::string tool_list(const std::vector<ListedTool>& tools) {
  std::size_t term = 0;
  for (const ListedTool& tool : tools) term = std::max(term, tool.name.size());
  term += 4;
  std::string text;
  for (const TaskWords& t : kTasks) {
    bool begun = false;
    for (const ListedTool& tool : tools) {
      if (tool.task != t.task) continue;
      if (!begun) text += (text.empty() ? "" : "\n") + std::string(t.title) + ":\n";
      begun = true;
      text += "  " + tool.name + std::string(term - 2 - tool.name.size(), ' ') +
              wrapped(tool.summary, term, term);
    }
  }
  return text;
}

}  // namespace hapsim
