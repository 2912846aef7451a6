// Text in lines of a terminal's width.
#pragma once

#include <cstddef>
#include <string>

namespace hapsim {

inline constexpr std::size_t kTextWidth = 80;

// Columns that UTF-8 text takes.
std::size_t columns(const std::string& text);

// `text` in lines of at most kTextWidth, the first one continued from column `at`; ends with a
// newline.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t at);

}  // namespace hapsim
