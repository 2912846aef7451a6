// Numbers as text, independent of the locale.
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

// Parses one finite number, the whole of `text` apart from spaces around it. Too small to be told
// from zero gives zero; too large is refused.
bool parse_number(std::string_view text, double& value);

// Shortest text that reads back as the same double ("0.1", "1e-07", "nan").
std::string format_number(double value);

// `text` without spaces and tabs around it.
std::string_view trim(std::string_view text);

// Text for an error message: quoted, cut to 40 bytes, without control characters.
std::string shown(std::string_view text);

}  // namespace hapsim
