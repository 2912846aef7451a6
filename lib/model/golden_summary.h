// A comparison with a golden model on a screen.
#pragma once

#include <fmt/format.h>

#include "cli/summary.h"
#include "model/golden_report.h"

namespace hapsim {

// Whether the model of file `model` is that of file `golden`; for programs each parameter with its
// golden value and what is allowed between them.
inline Summary golden_summary(const std::vector<GoldenRow>& rows, const std::string& model,
                              const std::string& golden) {
  Summary s;
  int differ = 0;
  const std::vector<JunitCase> cases = golden_cases(rows);  // which have the names
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const GoldenRow& row = rows[k];
    differ += row.verdict == GoldenVerdict::kSame ? 0 : 1;
    s.values.push_back({cases[k].name, row.value, row.unit});
    s.values.push_back({"golden." + cases[k].name, row.golden, row.unit});
    s.values.push_back({"allowed." + cases[k].name, row.allowed, row.unit});
  }
  s.values.push_back({"differ", static_cast<double>(differ), "1"});
  s.mark = differ == 0 ? Summary::Mark::kGood : Summary::Mark::kBad;
  s.verdict = differ == 0 ? fmt::format("{}: {} parameters and errors are those of {}", model,
                                        rows.size(), golden)
                          : fmt::format("{}: {} of {} parameters and errors differ from {}", model,
                                        differ, rows.size(), golden);
  return s;
}

}  // namespace hapsim
