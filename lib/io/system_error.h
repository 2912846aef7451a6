// Failures of system calls as one line that says the mend.
#pragma once

#include <string>

namespace hapsim {

// Throws Error(kIo) "where: doing: No space left on device; free some space ...".
[[noreturn]] void fail_system(const std::string& where, const std::string& doing, int error);

}  // namespace hapsim
