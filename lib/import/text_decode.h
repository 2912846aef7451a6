// Bytes of unknown origin as UTF-8: machines export UTF-16, Windows code pages and UTF-8 alike.
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

// UTF-16 (by its byte-order mark) and Windows-1252 (what is no valid UTF-8) become UTF-8; a
// byte-order mark goes, and line ends become "\n". Error(kBadInput) for what is certainly no text.
std::string decode_text(std::string bytes, const std::string& name);

// Lower-case ASCII letters and digits of `text` for comparison: umlauts become ae, oe, ue, ss; a
// micro sign becomes u; everything else stays as it is or, outside ASCII, goes.
std::string fold(std::string_view text);

}  // namespace hapsim
