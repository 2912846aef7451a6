#include "link/key_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "base/error.h"
#include "io/number.h"
#include "io/system_error.h"

namespace hapsim {
namespace {

constexpr const char* kDigits = "0123456789abcdef";

int value_of(char c) {
  const std::size_t at = std::string(kDigits).find(c);
  return at == std::string::npos ? -1 : static_cast<int>(at);
}

class File {
 public:
  File(const std::string& path, int flags)
      : fd_(uninterrupted([&] { return open(path.c_str(), flags | O_CLOEXEC, 0600); })) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

Secret read_key(const std::string& path) {
  const File file(path, O_RDONLY | O_NONBLOCK);
  struct stat info = {};
  if (file.fd() < 0 || fstat(file.fd(), &info) != 0) fail_system(path, "cannot be opened", errno);
  if (!S_ISREG(info.st_mode)) fail_io(path, "is no file", "name a key file: hs-link --make-key");
  if ((info.st_mode & 077) != 0)
    fail_io(path, "others than its owner may read or write this key", "chmod 600 " + path);
  std::array<char, 80> text{};
  const ssize_t got = uninterrupted([&] { return read(file.fd(), text.data(), text.size() - 1); });
  if (got < 0) fail_system(path, "cannot be read", errno);
  std::string_view line = trim({text.data(), static_cast<std::size_t>(got)});
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  Secret key;
  bool good = line.size() == 2 * key.size();
  for (std::size_t i = 0; good && i < key.size(); ++i) {
    const int high = value_of(line[2 * i]), low = value_of(line[2 * i + 1]);
    good = high >= 0 && low >= 0;
    key[i] = static_cast<unsigned char>(16 * high + low);
  }
  if (!good || key == public_key())
    fail_input(path, "this is no key", "make one: hs-link --make-key FILE");
  return key;
}

void make_key(const std::string& path) {
  Secret key;
  draw_random(key);
  std::string line;
  for (const unsigned char byte : key) {
    line += kDigits[byte >> 4];
    line += kDigits[byte & 15];
  }
  line += '\n';
  const File file(path, O_WRONLY | O_CREAT | O_EXCL);
  if (file.fd() < 0 && errno == EEXIST)
    fail_io(path, "is there already", "choose another name; a key is never overwritten");
  if (file.fd() < 0) fail_system(path, "cannot be written", errno);
  if (uninterrupted([&] { return write(file.fd(), line.data(), line.size()); }) !=
          static_cast<ssize_t>(line.size()) ||
      fsync(file.fd()) != 0) {
    const int why = errno;
    unlink(path.c_str());
    fail_system(path, "cannot be written", why);
  }
}

Secret public_key() {
  return {};
}

}  // namespace hapsim
