// How far each recording of a batch has come.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "batch/chain.h"

namespace hapsim {

// What step.sh wrote down of a step that failed.
struct StepFailure {
  std::string step;
  int code = 0;
  std::string text;  // the line that says why, without line break
};

// The failure of one of these steps, or none.
std::optional<StepFailure> find_failure(const Batch& batch, const std::vector<int>& chain);

// kNotRun also where the manifest or a file that it names has changed since the rules were written.
enum class RecordingState { kDone, kFailed, kNotRun };

struct RecordingOutcome {
  RecordingState state = RecordingState::kNotRun;
  std::string message;  // of a failure: one line
  std::string command;  // that repeats the failure; "" when the row itself has a problem
  // Of the model; NaN and "" where there is none.
  double rmse = std::numeric_limits<double>::quiet_NaN();      // [N]
  double held_out = std::numeric_limits<double>::quiet_NaN();  // [N]
  double noise = std::numeric_limits<double>::quiet_NaN();     // [N]
  std::string effects;                                         // "elastic+viscoelastic"
  std::string modulus, nu;                                     // of region 0, as in the model
  std::string verdict;                                         // complete, incomplete, ...
  std::string missing;                                         // effects, separated by spaces
};

// In the order of the rows.
std::vector<RecordingOutcome> read_outcomes(const Batch& batch);

// One row a recording, in the manifest's order; no times, so that equal results are equal bytes.
// Opened as a spreadsheet nothing in it is a formula (io/formula.h).
void write_summary(std::ostream& out, const Batch& batch,
                   const std::vector<RecordingOutcome>& outcomes);

}  // namespace hapsim
