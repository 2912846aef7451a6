// Failures of system calls as one line that says the mend.
#pragma once

#include <cerrno>
#include <string>

namespace hapsim {

// Throws Error(kIo) "where: doing: No space left on device; free some space ...".
[[noreturn]] void fail_system(const std::string& where, const std::string& doing, int error);

// The result of a system call, which is made again when a signal interrupted it.
template <class Call>
auto uninterrupted(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

}  // namespace hapsim
