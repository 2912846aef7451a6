// What a shell needs to complete the flags of a tool.
#pragma once

#include <string>

#include "cli/tool.h"

namespace hapsim {

// A script for bash, zsh or fish: the flags, their choices, files where a file is named.
std::string completion(const ToolSpec& spec, const std::string& shell);

}  // namespace hapsim
