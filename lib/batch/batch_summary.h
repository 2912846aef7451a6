// A batch on a screen.
#pragma once

#include <map>
#include <sstream>

#include "batch/batch_report.h"
#include "cli/summary.h"

namespace hapsim {

// How many are done, and what their overview says in lines.
inline Summary batch_summary(const std::vector<RecordingOutcome>& outcomes,
                             const Overview& overview) {
  Summary s;
  double done = 0, failed = 0;
  std::map<std::string, double> verdicts, missing;
  for (const RecordingOutcome& o : outcomes) {
    done += o.state == RecordingState::kDone ? 1 : 0;
    failed += o.state == RecordingState::kFailed ? 1 : 0;
    if (!o.verdict.empty()) ++verdicts[o.verdict];
    std::istringstream names(o.missing);
    for (std::string name; names >> name;) ++missing[name];
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
  for (const auto& [effect, count] : missing) s.values.push_back({"missing." + effect, count, "1"});
  return s;
}

}  // namespace hapsim
