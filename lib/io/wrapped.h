// What a file is wrapped in, so that no reader of ours can see into it.
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

// Error(kBadInput, name) when the first bytes are those of compressed data, of a spreadsheet, of
// UTF-16 text, of UTF-8 with a mark before it or of a web page: says which, and how to get at what
// is in it.
void refuse_wrapped(const std::string& name, std::string_view first);

}  // namespace hapsim
