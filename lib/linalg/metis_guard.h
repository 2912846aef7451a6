// What METIS needs of the process while it orders.
#pragma once

#include <csignal>
#include <mutex>

namespace hapsim {

// One ordering at a time: METIS draws from the C library's rand(), which all threads share; side by
// side they would order, and so round, differently from run to run. And no SIGTERM in this thread:
// METIS catches it and jumps out of whatever it is doing, memory allocation included, after which
// the process hangs, or goes on with another ordering instead of ending.
class MetisGuard {
 public:
  MetisGuard() : lock_(one_at_a_time()) {
    sigset_t term;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &term, &before_);
  }
  ~MetisGuard() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  MetisGuard(const MetisGuard&) = delete;
  MetisGuard& operator=(const MetisGuard&) = delete;

 private:
  static std::mutex& one_at_a_time() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  sigset_t before_;
};

}  // namespace hapsim
