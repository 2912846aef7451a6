// Input by name ("-" is standard input) and output that is complete or absent.
#pragma once

#include <exception>
#include <istream>
#include <memory>
#include <ostream>
#include <string>

namespace hapsim {

// Standard output or a pipe was closed by its reader: ends a tool silently.
class ClosedPipe : public std::exception {
 public:
  const char* what() const noexcept override { return "closed pipe"; }
};

// A named source of bytes. name() is "stdin" for "-", else the path: it begins error messages.
class Input {
 public:
  // Error(kIo) when it cannot be opened; Error(kUsage) when standard input is asked for twice.
  explicit Input(const std::string& path_or_dash);
  ~Input();
  Input(Input&&) noexcept;
  // Bytes already in memory, under a name for error messages.
  static Input from_bytes(std::string bytes, const std::string& name);
  std::istream& stream();
  const std::string& name() const;
  // Next line without its newline, false at the end. Error(kBadInput) when a line exceeds 64 MB.
  bool read_line(std::string& line);
  std::string read_all();  // the rest; Error(kIo) on a read error
  // From now on the first SIGINT or SIGTERM is the end of this input, at once; a line that was not
  // whole by then is left. The next one ends the process as it would have. Ignored signals stay
  // ignored. For one input at a time.
  void end_on_signals();
  bool ended_by_signal() const;

 private:
  struct Impl;
  explicit Input(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// "-" or "" writes to standard output; a path is written beside the target and renamed by commit().
// Without commit() nothing is left behind (of what went to standard output, the last 256 kB).
// Devices and named pipes are written directly. Any failure, as of a full disk, is Error(kIo) where
// it happens, also out of stream(); a closed pipe is ClosedPipe. Bytes with NUL are refused by a
// terminal.
class Output {
 public:
  explicit Output(const std::string& path_or_dash);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  std::ostream& stream();
  void write(const std::string& bytes);
  void commit();  // flush, check, close, rename; call exactly once

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
