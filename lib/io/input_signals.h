// SIGINT and SIGTERM as the end of an input.
#pragma once

namespace hapsim {

// While one lives, the first of these signals puts an empty file in the place of `fd` and sets a
// flag: a read that waits is interrupted, and made again it meets the end. The next signal ends the
// process as it would have. Ignored signals stay ignored. One at a time.
class InputSignals {
 public:
  // Error(kIo) with the input's name when there are no file descriptors left.
  InputSignals(int fd, const char* name);
  ~InputSignals();
  InputSignals(const InputSignals&) = delete;
  InputSignals& operator=(const InputSignals&) = delete;
  static bool came();
};

}  // namespace hapsim
