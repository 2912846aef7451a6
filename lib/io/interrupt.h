// SIGINT and SIGTERM as a wish: a long search ends with the best it has, a stream with what was
// answered.
#pragma once

#include <string>

namespace hapsim {

// While one lives, the first of these signals sets a flag, and the next one ends the process as it
// would have without (temporary files removed). Signals that are ignored stay ignored. One at a
// time.
class Interrupt {
 public:
  Interrupt();
  // The first signal also ends the input `name` of this file descriptor: an empty file takes its
  // place, and a read that waits meets its end. Error(kIo) when there are no descriptors left.
  Interrupt(int input, const std::string& name);
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  bool asked() const;
};

}  // namespace hapsim
