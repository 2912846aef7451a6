// How far a batch has come, as an overview, in a line, and as cases for CI servers.
#pragma once

#include <string>
#include <vector>

#include "batch/outcome.h"
#include "report/junit.h"
#include "report/overview.h"

namespace hapsim {

// "20 of 23 recordings done, 2 failed, 1 not run".
std::string batch_verdict(const std::vector<RecordingOutcome>& outcomes);
// Every recording is done.
bool all_done(const std::vector<RecordingOutcome>& outcomes);

// `folder`: where the page will be; links to the recordings' own reports are relative to it.
// `program`: that made it, its version.
Overview batch_overview(const Batch& batch, const std::vector<RecordingOutcome>& outcomes,
                        const std::string& folder, const std::string& program);

// A case a recording: it fails with the line and the command of its failure; skipped where it was
// not run.
std::vector<JunitCase> batch_cases(const Batch& batch,
                                   const std::vector<RecordingOutcome>& outcomes);

}  // namespace hapsim
