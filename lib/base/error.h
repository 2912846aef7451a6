// How hapsim fails: one line that says where, what is wrong and what to do, and an exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace hapsim {

// Exit codes of every tool.
enum class ExitCode {
  kDone = 0,
  kCheckFailed = 1,    // done, and the asked check says no
  kUsage = 2,          // the command line is wrong, or names what is not there
  kBadInput = 3,       // a file or stream holds what cannot be used, or lacks what is needed
  kNoConvergence = 4,  // a numerical method failed or did not converge
  kIo = 5,             // reading or writing failed
};

// What is thrown for anything a user can mend. `what()` is the one line without the tool's name,
// "where: what is wrong; what to do"; `where` ("data.csv:17", may be empty) is part of it.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& where, const std::string& wrong, const std::string& mend);
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

[[noreturn]] void fail_usage(const std::string& wrong, const std::string& mend);
[[noreturn]] void fail_input(const std::string& where, const std::string& wrong,
                             const std::string& mend);
[[noreturn]] void fail_numerics(const std::string& where, const std::string& wrong,
                                const std::string& mend);
[[noreturn]] void fail_io(const std::string& where, const std::string& wrong,
                          const std::string& mend);

}  // namespace hapsim
