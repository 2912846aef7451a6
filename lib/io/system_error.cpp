#include "io/system_error.h"

#include <cerrno>
#include <system_error>

#include "base/error.h"

namespace hapsim {
namespace {

std::string mend(int error) {
  switch (error) {
    case ENOENT:
      return "check the name and that its folder exists";
    case EACCES:
    case EPERM:
      return "check the permissions";
    case EISDIR:
      return "name a file, not a folder";
    case ENOSPC:
    case EDQUOT:
      return "free some space or write elsewhere";
    case EFBIG:
      return "raise the limit (ulimit -f) or write elsewhere";
    case EBADF:
      return "it is closed; redirect it or name a file";
    case EROFS:
      return "write to another place";
    case EMFILE:
    case ENFILE:
      return "raise the limit of open files (ulimit -n)";
    default:
      return "check the device";
  }
}

}  // namespace

void fail_system(const std::string& where, const std::string& doing, int error) {
  fail_io(where, doing + ": " + std::generic_category().message(error), mend(error));
}

}  // namespace hapsim
