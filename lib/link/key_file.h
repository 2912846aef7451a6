// The key that both sides of a link have, and nobody else.
#pragma once

#include <string>

#include "link/seal.h"

namespace hapsim {

// A file of one line of 64 hexadecimal digits. Error(kIo): it cannot be read, or others than its
// owner may read or write it. Error(kBadInput): it holds something else.
Secret read_key(const std::string& path);
// A new one, for the owner alone. Error(kIo): also where there is a file already.
void make_key(const std::string& path);
// Of links without a key, known to everybody: what is sealed by it is whole, and open.
Secret public_key();

}  // namespace hapsim
