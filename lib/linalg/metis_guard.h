// What METIS needs of the process while it orders.
#pragma once

#include <mutex>

namespace hapsim {

// One ordering at a time: METIS draws from the C library's rand(), which all threads share; side by
// side they would order, and so round, differently from run to run. And no handler of SIGTERM but
// the program's own: METIS would put in one of its own for the whole process, which jumps out of
// whatever the thread that gets the signal is doing, and it would put the program's back as one
// that serves once.
class MetisGuard {
 public:
  MetisGuard();
  MetisGuard(const MetisGuard&) = delete;
  MetisGuard& operator=(const MetisGuard&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
};

}  // namespace hapsim
