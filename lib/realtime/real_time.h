// The operating system's side of a loop with a deadline.
#pragma once

#include <cstdint>
#include <string>

namespace hapsim {

// Locks the process's memory and asks for real-time scheduling (first in, first out) of the calling
// thread. Says in words what was granted and what was not, and why: "memory locked; no real-time
// scheduling (Operation not permitted: needs CAP_SYS_NICE or a limit rtprio)".
std::string enter_real_time();
// Standard input and output, where they are pipes, hold a megabyte: some seconds in which a loop
// need not wait for a process at the other end that is not scheduled.
void widen_pipes();
void leave_real_time();  // memory unlocked, ordinary scheduling

std::int64_t monotonic_ns();  // a clock that nobody sets [ns]

// Samples at a fixed rate by the clock: wait() returns when the next one is due.
class Pacer {
 public:
  explicit Pacer(double rate);  // [1/s]
  // Sleeps until shortly before the next sample is due and stays awake for the rest, at once where
  // that has passed; gives when it was due [ns]. The first sample is due now.
  std::int64_t wait();
  std::int64_t period() const { return period_; }  // [ns]

 private:
  double rate_;
  std::int64_t period_, start_ = 0, next_ = 0;
};

}  // namespace hapsim
