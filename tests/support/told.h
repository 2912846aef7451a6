// What a summary tells, in one line.
#pragma once

#include <sstream>
#include <string>

#include "cli/summary.h"

namespace hapsim::test {

// Words with one blank between them, however they are wrapped.
inline std::string told(const Summary& summary) {
  std::string text;
  for (const std::string& line : summary_lines(summary)) {
    std::istringstream words(line);
    for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  }
  return text;
}
inline bool tells(const Summary& summary, const std::string& text) {
  return told(summary).find(text) != std::string::npos;
}

}  // namespace hapsim::test
