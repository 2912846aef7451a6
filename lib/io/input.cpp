#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "base/error.h"
#include "io/interrupt.h"
#include "io/stream.h"
#include "io/system_error.h"

namespace hapsim {
namespace {

constexpr std::size_t kReadBlock = 256 * 1024;
constexpr std::size_t kLongestLine = 64 * 1024 * 1024;

std::atomic<bool> stdin_taken{false};

// Reads a file descriptor, or memory when fd is -1.
class ReadBuffer : public std::streambuf {
 public:
  ReadBuffer(int fd, std::string bytes, const std::string& name)
      : fd_(fd), bytes_(std::move(bytes)), name_(name) {
    if (fd_ >= 0)
      bytes_.resize(kReadBlock);
    else
      setg(bytes_.data(), bytes_.data(), bytes_.data() + bytes_.size());
  }
  ~ReadBuffer() override {
    if (fd_ > STDIN_FILENO) close(fd_);
  }

  // Unread bytes in memory; refilled when there are none; empty at the end.
  std::string_view available() {
    if (gptr() == egptr() && underflow() == traits_type::eof()) return {};
    return {gptr(), static_cast<std::size_t>(egptr() - gptr())};
  }
  void consume(std::size_t n) { setg(eback(), gptr() + n, egptr()); }
  int fd() const { return fd_; }

 protected:
  int_type underflow() override {
    if (gptr() < egptr()) return traits_type::to_int_type(*gptr());
    if (fd_ < 0) return traits_type::eof();
    const ssize_t got = uninterrupted([&] { return read(fd_, bytes_.data(), bytes_.size()); });
    if (got < 0) fail_system(name_, "cannot be read", errno);
    setg(bytes_.data(), bytes_.data(), bytes_.data() + got);
    return got == 0 ? traits_type::eof() : traits_type::to_int_type(*gptr());
  }

 private:
  int fd_;
  std::string bytes_;
  std::string name_;
};

int open_for_reading(const std::string& path) {
  if (path == "-") {
    if (stdin_taken.exchange(true))
      fail_usage("standard input can feed one input only", "name a file for the other");
    return STDIN_FILENO;
  }
  const int fd = uninterrupted([&] { return open(path.c_str(), O_RDONLY | O_CLOEXEC); });
  if (fd < 0) fail_system(path, "cannot be opened", errno);
  return fd;
}

}  // namespace

struct Input::Impl {
  Impl(int fd, std::string bytes, const std::string& label)
      : name(label), buffer(fd, std::move(bytes), label), stream(&buffer) {
    // Lets an Error thrown by the buffer out of the stream.
    stream.exceptions(std::ios::badbit);
  }
  std::string name;
  ReadBuffer buffer;
  std::istream stream;
  std::optional<Interrupt> interrupt;
};

Input::Input(const std::string& path_or_dash)
    : impl_(std::make_unique<Impl>(open_for_reading(path_or_dash), "",
                                   path_or_dash == "-" ? "stdin" : path_or_dash)) {}

Input::Input(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Input::~Input() = default;
Input::Input(Input&&) noexcept = default;

Input Input::from_bytes(std::string bytes, const std::string& name) {
  return Input(std::make_unique<Impl>(-1, std::move(bytes), name));
}

std::istream& Input::stream() {
  return impl_->stream;
}
const std::string& Input::name() const {
  return impl_->name;
}

void Input::end_on_signals() {
  impl_->interrupt.emplace(impl_->buffer.fd(), impl_->name);
}
bool Input::ended_by_signal() const {
  return impl_->interrupt && impl_->interrupt->asked();
}

bool Input::read_line(std::string& line) {
  line.clear();
  if (ended_by_signal()) return false;
  bool any = false;
  for (std::string_view text; !(text = impl_->buffer.available()).empty();) {
    any = true;
    const std::size_t newline = text.find('\n');
    const std::size_t length = newline == text.npos ? text.size() : newline;
    line.append(text.substr(0, length));
    impl_->buffer.consume(newline == text.npos ? length : length + 1);
    if (newline != text.npos) return true;
    if (line.size() > kLongestLine)
      fail_input(impl_->name, "a line is longer than 64 MB", "this is not a text file; check it");
  }
  return any && !ended_by_signal();
}

std::string Input::read_all() {
  std::string bytes;
  struct stat info = {};
  if (impl_->buffer.fd() >= 0 && fstat(impl_->buffer.fd(), &info) == 0 && S_ISREG(info.st_mode))
    bytes.reserve(static_cast<std::size_t>(info.st_size) + 1);
  for (std::string_view text; !(text = impl_->buffer.available()).empty();) {
    bytes.append(text);
    impl_->buffer.consume(text.size());
  }
  return bytes;
}

}  // namespace hapsim
