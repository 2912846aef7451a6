// Temporary files that a signal must not leave behind.
#pragma once

#include <string>

namespace hapsim {

// From now on SIGINT, SIGTERM, SIGHUP, SIGPIPE and crashes remove the registered files before the
// process ends as it would have ended; a file larger than allowed becomes a write error. Signals
// that are ignored or handled already are left alone.
void clean_up_on_signals();

// Holds one path registered for removal. The destructor removes the file unless kept(); a forked
// child never removes its parent's files.
class TempFile {
 public:
  // Creates a new file in `folder` with the usual permissions. Error(kIo) names `target`.
  TempFile(const std::string& folder, const std::string& target);
  ~TempFile();
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;
  int fd() const { return fd_; }
  const std::string& path() const { return path_; }
  void kept() { kept_ = true; }  // it has been renamed

 private:
  std::string path_;
  int fd_ = -1;
  int slot_ = -1;
  bool kept_ = false;
};

}  // namespace hapsim
