// The script of a step: its command, under the user's files that it reads.
#pragma once

#include <filesystem>
#include <string>

#include "batch/chain.h"

namespace hapsim {

// FOLDER/recordings/liver/model.sh
std::filesystem::path script_path(const Batch& batch, const BatchStep& step);

// A line for hapsim's version, one for each file of the user's with its size and time, and the
// command. make sees only files that are newer; with these an older copy that was put back, and one
// that changed after the clock was stepped back, are noticed too.
std::string script_of(const BatchStep& step, const std::string& version);

// Whether the script that is there is as it would be written now, by whatever version: neither the
// command nor a file of the user's is another.
bool is_current(const Batch& batch, const BatchStep& step);

}  // namespace hapsim
