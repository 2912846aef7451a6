// Regions on a screen.
#pragma once

#include <fmt/format.h>

#include "cli/summary.h"
#include "regions/region_report.h"

namespace hapsim {

// How the samples of `name` were divided, why or why not, and the values of each region.
inline Summary region_summary(const RegionEstimate& regions, std::size_t samples,
                              const std::string& name) {
  constexpr double kPoorTree = 0.75;
  constexpr std::size_t kMost = 14;
  Summary s;
  const std::size_t count = regions.value.size();
  s.mark = regions.correlation < kPoorTree || regions.joined > 0 ? Summary::Mark::kOpen
                                                                 : Summary::Mark::kGood;
  s.verdict =
      fmt::format("{}: {}", name, count == 1 ? "one region" : fmt::format("{} regions", count));
  s.size = fmt::format("{} location samples", samples);
  std::vector<std::string> lines = region_lines(regions, samples);
  if (lines.size() > kMost) {
    const std::size_t more = lines.size() - kMost;
    lines.resize(kMost);
    lines.push_back(fmt::format("... and {} more", more));
  }
  s.items = {{"REGIONS", "", "", std::move(lines)}};
  s.values = {{"region_count", static_cast<double>(count), "1"},
              {"samples", static_cast<double>(samples), "1"},
              {"cophenetic", regions.correlation, "1"}};
  if (!regions.tests.empty()) {
    s.values.push_back({"p_clusters", regions.tests.front().p_gaps, "1"});
    s.values.push_back({"p_scatter", regions.tests.front().p_scatter, "1"});
  }
  for (std::size_t r = 0; r < count; ++r) {
    const RegionValue& v = regions.value[r];
    s.values.push_back({fmt::format("elastic.E[{}]", r), v.E, "Pa", v.E_std});
    s.values.push_back({fmt::format("elastic.nu[{}]", r), v.nu, "1", v.nu_std});
  }
  return s;
}

}  // namespace hapsim
