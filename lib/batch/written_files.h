// The files that flags in a manifest's columns of options would write.
#pragma once

#include <string>
#include <vector>

#include "batch/manifest.h"

namespace hapsim {

// Puts `folder` before each relative path after a flag that writes a file (--history FILE,
// --history=FILE). Whether there was one.
bool place_written_files(std::vector<std::string>& words, const std::string& folder);

// Empty, or the option of the row that names a file outside its own folder ("--history /etc/x"):
// an absolute path, or one that climbs.
std::string written_outside(const ManifestRow& row);

}  // namespace hapsim
