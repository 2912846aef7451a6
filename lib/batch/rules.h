// A batch as files for make: the rules, and a script a step.
#pragma once

#include <string>

#include "batch/chain.h"

namespace hapsim {

struct PrepareReport {
  std::size_t ready = 0;          // recordings that make has rules for
  std::size_t refused = 0;        // that have a problem
  std::size_t failed_before = 0;  // that would fail again: nothing has changed since
};

// Writes below the batch's folder
//   batch.mk            rules for `make -C FOLDER -f batch.mk`; the command STEP runs a step, by
//                       default in a shell of its own
//   .../rules.mk        a recording's own steps, for a make of its own: one for all would begin
//                       every recording before it went on with the first
//   targets, array.sh   the recordings, and a task of a job array of Slurm that makes its share
//   step.sh             runs one step, for at most BatchOptions::step_time, and lets it write in
//   the
//                       recording's own folder alone: keeps what it says in STEP.log beside the
//                       output, and in `failure` the step, exit code and line of a failure
//   .../STEP.sh         the step's command, and the size and time of the user's files that it
//                       reads. Where that is another than before, or hapsim's version is, the
//                       step's result is removed with all that builds on it, and is made again
// A step that failed by bad input, wrong usage or no convergence is left out with all that builds
// on it, until its command or one of its inputs changes. `bin` goes before the PATH; may be empty.
PrepareReport write_rules(const Batch& batch, const std::string& bin, const std::string& version);

}  // namespace hapsim
