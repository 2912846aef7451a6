// Where a process may write, when whoever started it has said so.
#pragma once

#include <string>

namespace hapsim {

// The environment's HAPSIM_WRITES, a name a line: files, and with a slash at the end folders in
// which everything may be written. Absent: anywhere. hs-batch sets it for the commands that it
// makes of a manifest, whose options name what somebody else thought of.
inline constexpr const char* kWritesVariable = "HAPSIM_WRITES";

// Error(kIo) where the file may not be written. Links are followed first.
void require_allowed_output(const std::string& path);

}  // namespace hapsim
