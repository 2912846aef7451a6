// The files that flags in a manifest's columns of options name.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace hapsim {

// Gives each path after a flag that reads a file (--region FILE, --region=FILE, --fixed file:PATH,
// --simulated NAME=FILE) to `from_here`, and puts what it returns in its place. Returns those.
std::vector<std::string> name_files(
    std::vector<std::string>& words,
    const std::function<std::string(const std::string&)>& from_here);

}  // namespace hapsim
