// Bytes of unknown origin as lines of UTF-8.
#pragma once

#include <string>

#include "tables/encoding.h"

namespace hapsim {

// decode() with line ends as "\n". Error(kBadInput) for what is certainly no text.
DecodedText decode_text(const std::string& bytes, const std::string& encoding,
                        const std::string& name);

}  // namespace hapsim
