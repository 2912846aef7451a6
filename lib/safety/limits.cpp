#include "safety/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/nearest.h"
#include "io/csv.h"
#include "io/number.h"

namespace hapsim {
namespace {

std::vector<std::pair<std::string, double*>> named(SafetyLimits& limits) {
  std::vector<std::pair<std::string, double*>> all{
      {"force", &limits.force},   {"rate", &limits.rate},       {"power", &limits.power},
      {"speed", &limits.speed},   {"hold", &limits.hold},       {"ramp", &limits.ramp},
      {"energy", &limits.energy}, {"damping", &limits.damping}, {"lever", &limits.lever}};
  for (int k = 0; k < 3; ++k) {
    all.emplace_back(std::string(1, "xyz"[k]) + "_low", &limits.low[k]);
    all.emplace_back(std::string(1, "xyz"[k]) + "_high", &limits.high[k]);
  }
  return all;
}

// What is wrong and what to do; empty where nothing is.
std::pair<std::string, std::string> problem(const SafetyLimits& limits) {
  const std::array<std::pair<const char*, double>, 7> positive{{{"force", limits.force},
                                                                {"rate", limits.rate},
                                                                {"power", limits.power},
                                                                {"speed", limits.speed},
                                                                {"hold", limits.hold},
                                                                {"ramp", limits.ramp},
                                                                {"lever", limits.lever}}};
  for (const auto& [name, value] : positive)
    if (!(value > 0))
      return {fmt::format("the limit of {} is {:g}", name, value), "give a positive one"};
  for (const auto& [name, value] :
       {std::pair{"energy", limits.energy}, std::pair{"damping", limits.damping}})
    if (!(value >= 0))
      return {fmt::format("the limit of {} is {:g}", name, value), "give none below zero"};
  if (limits.force > limits.rate * limits.ramp)
    return {fmt::format("a force of {:g} N falls to zero within {:g} s faster than {:g} N/s",
                        limits.force, limits.ramp, limits.rate),
            "allow a longer ramp, a higher rate or less force"};
  if (!((limits.low.array() < limits.high.array()).all()))
    return {"the workspace has no inside", "give its low corner, then its high one"};
  return {};
}

}  // namespace

void check(const SafetyLimits& limits) {
  if (const auto [wrong, mend] = problem(limits); !wrong.empty()) fail_usage(wrong, mend);
}

SafetyLimits read_limits(Input& input, SafetyLimits limits) {
  const CsvTable table = read_csv(input);
  const int limit = table.find("limit"), value = table.find("value");
  for (const auto& [column, name] : {std::pair{limit, "limit"}, std::pair{value, "value"}})
    if (column < 0) fail_missing_column(table.name, name, table.header, {"limit", "value"});
  const auto all = named(limits);
  std::vector<std::string> names;
  for (const auto& entry : all) names.push_back(entry.first);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const std::string where = fmt::format("{}:{}", table.name, table.line[r]);
    const std::string& name = table.columns[static_cast<std::size_t>(limit)][r];
    const std::string& text = table.columns[static_cast<std::size_t>(value)][r];
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const auto& entry) { return entry.first == name; });
    if (found == all.end()) {
      const std::string near = nearest(name, names);
      fail_input(where, "there is no limit " + shown(name),
                 near.empty() ? "known are force, rate, power, speed, hold, ramp, energy, damping, "
                                "lever, x_low ... z_high"
                              : "did you mean '" + near + "'?");
    }
    if (!parse_number(text, *found->second))
      fail_input(where, name + " is " + shown(text), "write a finite number in SI");
  }
  if (const auto [wrong, mend] = problem(limits); !wrong.empty())
    fail_input(table.name, wrong, mend);
  return limits;
}

}  // namespace hapsim
