// A batch on a screen.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "batch/batch_report.h"
#include "cli/summary.h"

namespace hapsim {

// How many are done, and what their overview says in lines.
inline Summary batch_summary(const std::vector<RecordingOutcome>& outcomes,
                             const Overview& overview) {
  Summary s;
  double done = 0, failed = 0;
  std::map<std::string, double> verdicts;
  std::vector<std::string> missing;
  for (const RecordingOutcome& o : outcomes) {
    done += o.state == RecordingState::kDone ? 1 : 0;
    failed += o.state == RecordingState::kFailed ? 1 : 0;
    if (!o.verdict.empty()) ++verdicts[o.verdict];
    missing.push_back(o.missing);
  }
  s.mark = all_done(outcomes) ? Summary::Mark::kGood
           : failed > 0       ? Summary::Mark::kBad
                              : Summary::Mark::kOpen;
  s.verdict = overview.verdict;
  const std::vector<std::string> lines = overview_lines(overview);
  if (!lines.empty()) s.items.push_back({"MODELS", "", "", lines});
  s.values = {{"recordings", static_cast<double>(outcomes.size()), "1"},
              {"done", done, "1"},
              {"failed", failed, "1"}};
  for (const auto& [verdict, count] : verdicts)
    s.values.push_back({"verdict." + verdict, count, "1"});
  for (const auto& [effect, count] : count_names(missing))
    s.values.push_back({"missing." + effect, static_cast<double>(count), "1"});
  return s;
}

}  // namespace hapsim
