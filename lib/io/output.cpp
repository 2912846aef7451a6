#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "base/error.h"
#include "io/allowed_outputs.h"
#include "io/require_output.h"
#include "io/stream.h"
#include "io/system_error.h"
#include "io/temp_files.h"

namespace hapsim {
namespace {

constexpr std::size_t kWriteBlock = 256 * 1024;

// Writes a file descriptor; throws where the write fails. What is not flushed is dropped.
class WriteBuffer : public std::streambuf {
 public:
  explicit WriteBuffer(const std::string& name) : name_(name), block_(kWriteBlock) {
    setp(block_.data(), block_.data() + block_.size());
  }
  void attach(int fd) {
    fd_ = fd;
    terminal_ = isatty(fd) == 1;
  }
  void flush() {
    const auto n = static_cast<std::size_t>(pptr() - pbase());
    setp(block_.data(), block_.data() + block_.size());
    put(block_.data(), n);
  }

 protected:
  int_type overflow(int_type c) override {
    flush();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  int sync() override {
    flush();
    return 0;
  }
  std::streamsize xsputn(const char* bytes, std::streamsize n) override {
    if (n <= epptr() - pptr()) {
      std::memcpy(pptr(), bytes, static_cast<std::size_t>(n));
      pbump(static_cast<int>(n));
      return n;
    }
    flush();
    if (n < epptr() - pptr()) return xsputn(bytes, n);
    put(bytes, static_cast<std::size_t>(n));
    return n;
  }

 private:
  void put(const char* bytes, std::size_t n) {
    if (terminal_ && std::memchr(bytes, '\0', n) != nullptr)
      fail_usage("the result is binary and standard output is a terminal", "use -o FILE or a pipe");
    while (n > 0) {
      const ssize_t done = uninterrupted([&] { return ::write(fd_, bytes, n); });
      if (done < 0 && errno == EPIPE) throw ClosedPipe();
      if (done < 0) fail_system(name_, "cannot be written", errno);
      bytes += done;
      n -= static_cast<std::size_t>(done);
    }
  }

  std::string name_;
  std::vector<char> block_;
  int fd_ = -1;
  bool terminal_ = false;
};

// A link is followed, so that the file it names is replaced and not the link.
std::string resolved(const std::string& path) {
  char real[PATH_MAX];
  return realpath(path.c_str(), real) != nullptr ? std::string(real) : path;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == path.npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Whether it exists, and as what; nothing is made.
bool require_writable(const std::string& path, struct stat& info) {
  require_allowed_output(path);
  const bool exists = stat(path.c_str(), &info) == 0;
  if (path.back() == '/' || (exists && S_ISDIR(info.st_mode)))
    fail_system(path, "cannot be written", EISDIR);
  if (exists && access(path.c_str(), W_OK) != 0) fail_system(path, "cannot be written", errno);
  return exists;
}

}  // namespace

struct Output::Impl {
  explicit Impl(const std::string& path)
      : to_stdout(path.empty() || path == "-"),
        name(to_stdout ? "standard output" : path),
        buffer(name),
        stream(&buffer) {
    stream.exceptions(std::ios::badbit);  // lets an Error thrown by the buffer out of the stream
    if (to_stdout) {
      fd = STDOUT_FILENO;
    } else {
      open_file(path);
    }
    buffer.attach(fd);
  }
  ~Impl() {
    if (fd > STDERR_FILENO) close(fd);
  }

  void open_file(const std::string& path) {
    struct stat info = {};
    const bool exists = require_writable(path, info);
    if (exists && !S_ISREG(info.st_mode)) {
      fd = uninterrupted([&] { return open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY); });
      if (fd < 0) fail_system(path, "cannot be written", errno);
      return;
    }
    target = resolved(path);
    temp.emplace(folder_of(target), path);
    fd = temp->fd();
    if (exists && fchmod(fd, info.st_mode & 07777) != 0)
      fail_system(path, "its permissions cannot be kept", errno);
  }

  // Some file systems tell of a failed write only when the file is closed.
  void close_checked() {
    const int closing = to_stdout ? dup(fd) : fd;
    if (!to_stdout) fd = -1;
    // Interrupted it is closed all the same.
    if (closing < 0 || (close(closing) != 0 && errno != EINTR))
      fail_system(name, "cannot be written", errno);
  }

  void commit() {
    stream.flush();
    if (temp && uninterrupted([&] { return fsync(fd); }) != 0 && errno != EINVAL && errno != EROFS)
      fail_system(name, "cannot be written", errno);
    close_checked();
    if (!temp) return;
    if (std::rename(temp->path().c_str(), target.c_str()) != 0)
      fail_system(name, "cannot be put in its place", errno);
    temp->kept();
    temp.reset();
    const int folder = uninterrupted(
        [&] { return open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (folder < 0) return;
    uninterrupted([&] {
      return fsync(folder);
    });  // the rename survives a power cut; the data are safe either way
    close(folder);
  }

  bool to_stdout;
  std::string name;
  std::string target;
  std::optional<TempFile> temp;
  int fd = -1;
  WriteBuffer buffer;
  std::ostream stream;
  bool committed = false;
};

void require_output(const std::string& path_or_dash) {
  if (path_or_dash.empty() || path_or_dash == "-") return;
  struct stat info = {};
  const bool exists = require_writable(path_or_dash, info);
  if (exists && !S_ISREG(info.st_mode)) return;
  if (access(folder_of(resolved(path_or_dash)).c_str(), W_OK | X_OK) != 0)
    fail_system(path_or_dash, "cannot be created", errno);
}

Output::Output(const std::string& path_or_dash) : impl_(std::make_unique<Impl>(path_or_dash)) {}
Output::~Output() = default;

std::ostream& Output::stream() {
  return impl_->stream;
}

void Output::write(const std::string& bytes) {
  impl_->stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void Output::commit() {
  assert(!impl_->committed);
  impl_->committed = true;
  impl_->commit();
}

}  // namespace hapsim
