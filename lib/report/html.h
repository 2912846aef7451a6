// Text from files, safe inside HTML and inside a script.
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

// Escapes & < > " ' for element text and quoted attributes; control characters become spaces and
// bytes that are not UTF-8 a replacement character, so no file can change the page.
std::string escape_html(std::string_view text);

// A JavaScript string literal with its quotes; '<' is written \u003c so that "</script>" cannot end
// the script.
std::string script_string(std::string_view text);

}  // namespace hapsim
