// SIGINT and SIGTERM as a wish: a long search ends with the best it has.
#pragma once

namespace hapsim {

// While one lives, the first of these signals sets a flag, and the next one ends the process as it
// would have without (temporary files removed). Signals that are ignored stay ignored. One at a
// time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  bool asked() const;
};

}  // namespace hapsim
