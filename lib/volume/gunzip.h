// Unpacking of gzip, with a bound on the result.
#pragma once

#include <cstddef>
#include <string>

namespace hapsim {

bool is_gzip(const std::string& bytes);

// At most the first `most` unpacked bytes. Memory grows with what is really there. Error(kBadInput,
// name) when the packed bytes are damaged; what a truncated file still holds is returned.
std::string gunzip(const std::string& bytes, std::size_t most, const std::string& name);

// No gzip unpacks to more than this many times its size.
constexpr double kMostGzipRatio = 1040;

}  // namespace hapsim
