// Runs a shell command and gathers what it leaves.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace hapsim {

struct Outcome {
  int code = -1;  // as a shell tells it: 128 + the signal's number when killed
  std::string out;
  std::string err;
};

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// A folder of its own, removed at the end; commands run inside it, with $S for the sample tool.
class Workplace {
 public:
  Workplace() {
    char name[] = "/tmp/hapsim-test-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~Workplace() { std::filesystem::remove_all(folder_); }

  Outcome run(const std::string& command) const {
    const std::string out = folder_ / ".out", err = folder_ / ".err";
    const std::string script = "cd '" + folder_.string() + "' && S='" HAPSIM_SAMPLE "' && { " +
                               command + "\n} >'" + out + "' 2>'" + err + "'";
    const int status = std::system(("bash -c " + quoted(script)).c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(out),
                    contents(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
  }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  bool empty() const { return std::filesystem::is_empty(folder_); }

 private:
  static std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
    return result + "'";
  }

  std::filesystem::path folder_;
};

}  // namespace hapsim
