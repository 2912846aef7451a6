#include "cli/wrap.h"

#include <algorithm>

namespace hapsim {

std::size_t columns(const std::string& text) {
  std::size_t n = 0;
  for (const char c : text) n += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  return n;
}

std::string wrapped(const std::string& text, std::size_t indent, std::size_t at) {
  std::string result;
  bool line_begins = true;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", start), text.size());
    const std::string word = text.substr(start, end - start);
    start = end + 1;
    if (word.empty()) continue;
    if (!line_begins && at + 1 + columns(word) > kTextWidth) {
      result += '\n' + std::string(indent, ' ');
      at = indent;
      line_begins = true;
    }
    result += (line_begins ? "" : " ") + word;
    at += columns(word) + (line_begins ? 0 : 1);
    line_begins = false;
  }
  return result + '\n';
}

}  // namespace hapsim
