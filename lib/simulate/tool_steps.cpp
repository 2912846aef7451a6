#include "simulate/tool_steps.h"

#include <fmt/format.h>

#include <map>

#include "base/error.h"
#include "recording/tools_together.h"

namespace hapsim {

std::string recording_line(const Recording& r, std::size_t row) {
  return fmt::format("{}:{}", r.name, r.line[row]);
}

std::vector<Press> common_presses(const Recording& r) {
  std::vector<Press> result;
  std::map<int, std::size_t> index;
  for (std::size_t row = 0; row < r.rows(); ++row) {
    const auto [found, is_new] = index.try_emplace(r.press[row], result.size());
    if (is_new) result.push_back({r.press[row], {}});
    result[found->second].rows.push_back(static_cast<int>(row));
  }
  return result;
}

ToolSteps tool_steps(const Recording& r, const Press& press) {
  const std::vector<std::string>* tool = tool_ids(r);
  ToolSteps steps;
  for (const int i : press.rows) {
    const auto row = static_cast<std::size_t>(i);
    bool joins = tool != nullptr && !steps.rows.empty();
    if (joins) {
      for (const std::size_t other : steps.rows.back())
        joins = joins && (*tool)[other] != (*tool)[row] && (r.t.empty() || r.t[other] == r.t[row]);
    }
    if (!joins) steps.rows.emplace_back();
    steps.rows.back().push_back(row);
    const std::vector<std::size_t>& first = steps.rows.front();
    const std::size_t place = steps.rows.back().size() - 1;
    const bool known = steps.rows.size() == 1 || place < first.size();
    if (!known || (tool != nullptr && (*tool)[first[place]] != (*tool)[row]) ||
        (r.position[first[place]] - r.position[row]).norm() > 1e-4)
      fail_input(recording_line(r, row), "the tools or their contact points change within a press",
                 "give every step the same tools in the same order, and each contact its press");
  }
  if (steps.rows.back().size() != steps.tools())
    fail_input(recording_line(r, steps.rows.back().front()),
               "a tool is missing in the last step of a press", "give every step the same tools");
  return steps;
}

}  // namespace hapsim
