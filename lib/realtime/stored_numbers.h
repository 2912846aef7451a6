// Numbers as a file of the cache keeps them: what they are, themselves, and a sum that tells
// damage.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hapsim {

// `kind`: eight letters, which change with what the numbers mean.
std::string stored_numbers(const std::string& kind, const std::vector<double>& numbers);
// Nothing: of another kind, or damaged.
std::optional<std::vector<double>> read_numbers(const std::string& kind, const std::string& bytes);

}  // namespace hapsim
