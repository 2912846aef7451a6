// What the flags of live forces mean: bits of the columns beyond and safety.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hapsim {

// By column: each bit with what it says of the force.
std::map<std::string, std::vector<std::pair<int, std::string>>> live_flag_meanings();

}  // namespace hapsim
