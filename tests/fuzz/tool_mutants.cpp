// tool_mutants [-c] COUNT EXAMPLE MUTANT COMMAND...: damages the file EXAMPLE in COUNT ways, writes
// each to the file MUTANT, which COMMAND reads, and counts how COMMAND ends. A tool must end with 0
// or with 3 (with -c also with 1) and then say so: lines that begin with its name. Mutants with
// which it does otherwise, takes more than a minute or 4 GB, are kept as MUTANT.N. An interrupted
// call, or one of a smaller COUNT, is gone on with: MUTANT.progress says where; mutants that were
// kept are tried again first. Prints one line: how many ended with 0, how many with 3, how many
// otherwise and, for these, the first number N; exit code 1 when there are any.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz/mutant.h"

namespace fs = std::filesystem;
using namespace hapsim;

namespace {

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

// The exit code, or 128 and the signal's number; what is said goes to the file `said`.
int run(char** command, const std::string& said) {
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_RDWR),
              told = open(said.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0666);
    if (null < 0 || told < 0) _exit(125);
    dup2(null, 0), dup2(null, 1), dup2(told, 2);
#if !defined(__SANITIZE_ADDRESS__)
    const rlimit memory{4UL << 30, 4UL << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit seconds{60, 60}, core{0, 0};
    setrlimit(RLIMIT_CPU, &seconds);
    setrlimit(RLIMIT_CORE, &core);
    execv(command[0], command);
    _exit(126);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool well_said(const std::string& said, const std::string& tool) {
  std::istringstream lines(said);
  std::string line;
  int count = 0;
  for (; std::getline(lines, line); ++count)
    if (line.rfind(tool + ": ", 0) != 0) return false;
  return count > 0;
}

// Where a call went on to, and how the mutants so far ended.
struct Progress {
  long next = 0, done = 0, refused = 0;  // 0: the example itself has not been tried
  std::set<long> otherwise;

  bool read(const std::string& file) {
    std::ifstream in(file);
    long n;
    if (!(in >> next >> done >> refused)) return false;
    while (in >> n) otherwise.insert(n);
    return true;
  }
  void write(const std::string& file) const {
    {
      std::ofstream out(file + ".new", std::ios::trunc);
      out << next << ' ' << done << ' ' << refused;
      for (const long n : otherwise) out << ' ' << n;
      out << '\n';
    }
    fs::rename(file + ".new", file);
  }
};

class Trial {
 public:
  Trial(bool checks, std::string file, char** command)
      : checks_(checks),
        file_(std::move(file)),
        command_(command),
        tool_(fs::path(command[0]).filename().string()) {
    progress.read(file_ + ".progress");
  }

  // The exit code with these bytes; counted as the mutant of that number, if it has one.
  int with(const std::string& bytes, long number) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << bytes;
    const int code = run(command_, said());
    if (number == 0) return code;
    const std::string kept = file_ + "." + std::to_string(number);
    const bool refused = code == 3 && well_said(content(said()), tool_);
    if (code == 0 || (checks_ && code == 1) || refused) {
      ++(refused ? progress.refused : progress.done);
      progress.otherwise.erase(number);
      fs::remove(kept);
      fs::remove(kept + ".said");
    } else {
      progress.otherwise.insert(number);
      std::ofstream(kept, std::ios::binary) << bytes;
      std::ofstream(kept + ".said") << "exit " << code << "\n" << content(said());
    }
    return code;
  }
  void again(long number) { with(content(file_ + "." + std::to_string(number)), number); }
  void save() const { progress.write(file_ + ".progress"); }
  std::string said() const { return file_ + ".said"; }

  Progress progress;

 private:
  bool checks_;
  std::string file_;
  char** command_;
  std::string tool_;
};

}  // namespace

int main(int argc, char** argv) {
  const bool checks = argc > 1 && std::strcmp(argv[1], "-c") == 0;
  if (checks) --argc, ++argv;
  if (argc < 5) {
    std::fprintf(stderr, "usage: tool_mutants [-c] COUNT EXAMPLE MUTANT COMMAND...\n");
    return 2;
  }
  const long count = std::atol(argv[1]);
  const std::string good = content(argv[2]);
  Trial trial(checks, argv[3], argv + 4);
  Progress& progress = trial.progress;
  if (const int code = trial.with(good, 0); code != 0) {
    std::fprintf(stderr, "tool_mutants: the valid file ends with exit %d: %s", code,
                 content(trial.said()).c_str());
    return 2;
  }
  for (const long number : std::set<long>(progress.otherwise)) trial.again(number);
  Random random(13);
  progress.next = std::max(progress.next, 1L);
  for (long k = 1; k <= count; ++k) {
    const std::string bad = fuzz::mutant(good, random);  // the same ones in every call
    if (k < progress.next) continue;
    trial.with(bad, k);
    progress.next = k + 1;
    if (k % 20 == 0) trial.save();
  }
  trial.save();
  std::printf("%ld %ld %zu %ld\n", progress.done, progress.refused, progress.otherwise.size(),
              progress.otherwise.empty() ? 0 : *progress.otherwise.begin());
  return progress.otherwise.empty() ? 0 : 1;
}
