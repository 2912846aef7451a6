#include "tables/scratch_file.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "base/error.h"

namespace hapsim {

ScratchFile::ScratchFile(const std::string& bytes, const std::string& target)
    : file_(std::filesystem::temp_directory_path().string(), target) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(file_.fd(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail_io(target, "a temporary copy cannot be written", "free room in TMPDIR");
    done += static_cast<std::size_t>(n);
  }
}

}  // namespace hapsim
