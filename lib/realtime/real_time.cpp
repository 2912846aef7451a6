#include "realtime/real_time.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

namespace hapsim {

std::string enter_real_time() {
  std::string said;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0)
    said = "memory locked";
  else
    said = std::string("memory not locked (") + std::strerror(errno) + ": raise ulimit -l)";
  prctl(PR_SET_TIMERSLACK, 1UL);  // of the calling thread's sleeps [ns]
  sched_param priority{};
  priority.sched_priority = sched_get_priority_min(SCHED_FIFO) + 49;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) == 0) return said + "; real-time scheduling";
  return said + "; no real-time scheduling (" + std::strerror(errno) +
         ": needs CAP_SYS_NICE or ulimit -r)";
}

void widen_pipes() {
  constexpr int kBytes = 1 << 20;  // what anybody may ask for
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO}) fcntl(fd, F_SETPIPE_SZ, kBytes);
}

void leave_real_time() {
  munlockall();
  const sched_param ordinary{};
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
}

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

namespace {

// A sleeper wakes some 30 us after its time, a processor at rest later yet: the last stretch is
// waited for awake [ns].
constexpr std::int64_t kAwake = 60'000;

void sleep_until(std::int64_t when) {
  timespec at{};
  at.tv_sec = static_cast<time_t>(when / 1'000'000'000);
  at.tv_nsec = static_cast<long>(when % 1'000'000'000);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
  }
}

}  // namespace

Pacer::Pacer(double rate) : rate_(rate), period_(std::llround(1e9 / rate)) {}

std::int64_t Pacer::wait() {
  if (next_ == 0) start_ = monotonic_ns();
  // From the start, so that a period that is no whole number of nanoseconds does not drift.
  const std::int64_t due = start_ + std::llround(1e9 * static_cast<double>(next_++) / rate_);
  if (monotonic_ns() < due - kAwake) sleep_until(due - kAwake);
  while (monotonic_ns() < due) {
  }
  return due;
}

}  // namespace hapsim
