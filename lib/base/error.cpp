#include "base/error.h"

#include <algorithm>

namespace hapsim {
namespace {

std::string one_line(const std::string& where, const std::string& wrong, const std::string& mend) {
  std::string line = where.empty() ? wrong : where + ": " + wrong;
  if (!mend.empty()) line += "; " + mend;
  // Names out of files may hold line breaks.
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line;
}

}  // namespace

Error::Error(ExitCode code, const std::string& where, const std::string& wrong,
             const std::string& mend)
    : std::runtime_error(one_line(where, wrong, mend)), code_(code) {}

void fail_usage(const std::string& wrong, const std::string& mend) {
  throw Error(ExitCode::kUsage, "", wrong, mend);
}

void fail_input(const std::string& where, const std::string& wrong, const std::string& mend) {
  throw Error(ExitCode::kBadInput, where, wrong, mend);
}

void fail_numerics(const std::string& where, const std::string& wrong, const std::string& mend) {
  throw Error(ExitCode::kNoConvergence, where, wrong, mend);
}

void fail_io(const std::string& where, const std::string& wrong, const std::string& mend) {
  throw Error(ExitCode::kIo, where, wrong, mend);
}

}  // namespace hapsim
