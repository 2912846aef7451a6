// A fusion on a screen.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "cli/summary.h"
#include "fusion/fusion_words.h"

namespace hapsim {

// Whether the filter knew its own error, and, where `exact` is given, the fused forces and what
// else could have been given out beside the exact ones. Errors as quality_lines().
inline Summary fusion_summary(const Recording& fast, const FusedForces& fused,
                              const Recording* exact) {
  Summary s;
  const FusionReport& report = fused.report;
  s.values = {{"slow_forces", static_cast<double>(report.observations), "1"},
              {"refused", static_cast<double>(report.refused), "1"}};
  if (exact != nullptr) s.items.push_back({"ERROR", "", "", quality_lines(fast, fused, *exact)});
  if (report.observations == 0) {
    s.mark = Summary::Mark::kOpen;
    s.verdict = fast.name + ": no slow force came in time";
    return s;
  }
  const auto band = report.band();
  const double mean = report.mean_nis();
  const bool knows = mean >= band[0] && mean <= band[1];
  s.mark = knows ? Summary::Mark::kGood : Summary::Mark::kOpen;
  s.verdict = fast.name + (knows ? ": fused; the filter knows its own error"
                                 : ": fused; the filter does not know its own error");
  if (std::isfinite(mean)) s.size = fmt::format("NIS {:.3g}", mean);
  s.items.push_back({"SLOW", "", "", {fusion_words(report)}});
  s.values.push_back({"nis", mean, "1"});
  s.values.push_back({"nis_low", band[0], "1"});
  s.values.push_back({"nis_high", band[1], "1"});
  if (exact == nullptr) return s;
  for (const auto& [name, force] : {std::pair{"error_fused", &fused.force},
                                    {"error_fast", &fast.f},
                                    {"error_held", &fused.held},
                                    {"error_extrapolated", &fused.extrapolated}})
    s.values.push_back({name, force_quality(fast, *force, exact->f).rms, "N"});
  return s;
}

}  // namespace hapsim
