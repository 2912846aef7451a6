#include "recording/tools_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace hapsim {

const std::vector<std::string>* tool_ids(const Recording& r) {
  const auto found = std::find(r.extra_header.begin(), r.extra_header.end(), "tool_id");
  return found == r.extra_header.end()
             ? nullptr
             : &r.extra[static_cast<std::size_t>(found - r.extra_header.begin())];
}

std::string tools_together(const Recording& r) {
  const std::vector<std::string>* tool = tool_ids(r);
  if (tool == nullptr || r.t.empty()) return "";
  std::map<double, std::size_t> first;  // row in contact of a time
  std::vector<char> together(r.rows(), 0);
  for (std::size_t row = 0; row < r.rows(); ++row) {
    if (r.in_air(row) || r.u[row].isZero()) continue;
    const auto [other, is_new] = first.try_emplace(r.t[row], row);
    if (!is_new && (*tool)[other->second] != (*tool)[row])
      together[row] = together[other->second] = 1;
  }
  const auto count = std::count(together.begin(), together.end(), 1);
  if (count == 0) return "";
  return fmt::format(
      "{}: in {} of {} rows another tool presses too, and moves the surface under this one; here "
      "each tool is taken by itself (hs-simulate --live and --full take them together)",
      r.name, count, r.rows());
}

}  // namespace hapsim
