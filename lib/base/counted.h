// Numbers of things in sentences.
#pragma once

#include <cstddef>
#include <string>

namespace hapsim {

// "1 press", "3 presses".
inline std::string counted(std::ptrdiff_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace hapsim
