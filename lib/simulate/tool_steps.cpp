#include "simulate/tool_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "recording/tools_together.h"

namespace hapsim {

std::string recording_line(const Recording& r, std::size_t row) {
  return fmt::format("{}:{}", r.name, r.line[row]);
}

namespace {

constexpr double kSamePlace = 1e-4;  // [m]

// Rows of one press number, of all tools, in order of first appearance.
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

ToolSteps steps_of(const Press& press, const Recording& r) {
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
        (r.position[first[place]] - r.position[row]).norm() > kSamePlace)
      fail_input(recording_line(r, row), "the tools or their contact points change within a press",
                 "give every step the same tools in the same order, and each contact its press");
  }
  if (steps.rows.back().size() != steps.touches())
    fail_input(recording_line(r, steps.rows.back().front()),
               "a tool is missing in the last step of a press", "give every step the same tools");
  return steps;
}

// Presses of several tools whose rows in contact lie between each other's.
ToolSteps steps_together(const std::vector<const Press*>& presses, const Recording& r) {
  const std::vector<std::string>& tool = *tool_ids(r);
  std::vector<std::size_t> rows;
  for (const Press* press : presses)
    for (const int row : press->rows) rows.push_back(static_cast<std::size_t>(row));
  std::sort(rows.begin(), rows.end());
  std::vector<std::size_t> touches;  // a row of each
  std::vector<std::size_t> touch_of;
  for (const std::size_t row : rows) {
    const auto known = std::find_if(touches.begin(), touches.end(), [&](std::size_t other) {
      return tool[other] == tool[row] && (r.position[other] - r.position[row]).norm() <= kSamePlace;
    });
    touch_of.push_back(static_cast<std::size_t>(known - touches.begin()));
    if (known == touches.end()) touches.push_back(row);
  }
  ToolSteps steps;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || r.t[rows[i]] != r.t[rows[i - 1]] ||
        steps.rows.back()[touch_of[i]] != ToolSteps::kNoRow)
      steps.rows.emplace_back(touches.size(), ToolSteps::kNoRow);
    steps.rows.back()[touch_of[i]] = rows[i];
  }
  return steps;
}

}  // namespace

std::vector<std::size_t> ToolSteps::first_rows() const {
  std::vector<std::size_t> first(touches(), kNoRow);
  for (auto step = rows.rbegin(); step != rows.rend(); ++step)
    for (std::size_t k = 0; k < first.size(); ++k)
      if ((*step)[k] != kNoRow) first[k] = (*step)[k];
  return first;
}

std::vector<ToolSteps> tool_steps(const Recording& r) {
  const std::vector<std::string>* tool = tool_ids(r);
  // Whether a row in contact is followed by this one while it still is.
  const auto overlaps = [&](int last, int first) {
    if (tool == nullptr || r.t.empty() || last < 0) return false;
    const auto a = static_cast<std::size_t>(last), b = static_cast<std::size_t>(first);
    return first < last || (r.t[a] == r.t[b] && (*tool)[a] != (*tool)[b]);
  };
  const std::vector<Press> presses = common_presses(r);
  std::vector<ToolSteps> result;
  std::vector<const Press*> together;
  int last = -1;  // row in contact of these
  const auto end_body = [&] {
    if (together.size() == 1)
      result.push_back(steps_of(*together.front(), r));
    else if (!together.empty())
      result.push_back(steps_together(together, r));
    together.clear();
    last = -1;
  };
  for (const Press& press : presses) {
    int first = -1, end = -1;
    for (const int row : press.rows)
      if (!r.in_air(static_cast<std::size_t>(row))) first = first < 0 ? row : first, end = row;
    if (first < 0 || !overlaps(last, first)) end_body();
    together.push_back(&press);
    last = std::max(last, end);
  }
  end_body();
  return result;
}

}  // namespace hapsim
