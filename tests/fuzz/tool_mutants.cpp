// tool_mutants [-c] COUNT EXAMPLE MUTANT COMMAND...: damages the file EXAMPLE in COUNT ways, writes
// each to the file MUTANT, which COMMAND reads, and counts how COMMAND ends. A tool must end with 0
// or with 3 (with -c also with 1) and then say so: lines that begin with its name. Mutants with
// which it does otherwise, takes more than a minute or 4 GB, are kept as MUTANT.N. Prints one line:
// how many ended with 0, how many with 3, how many otherwise and, for these, the first number N;
// exit code 1 when there are any.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
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

}  // namespace

int main(int argc, char** argv) {
  const bool checks = argc > 1 && std::strcmp(argv[1], "-c") == 0;
  if (checks) --argc, ++argv;
  if (argc < 5) {
    std::fprintf(stderr, "usage: tool_mutants [-c] COUNT EXAMPLE MUTANT COMMAND...\n");
    return 2;
  }
  const long count = std::atol(argv[1]);
  const std::string good = content(argv[2]), file = argv[3], said = file + ".said";
  const std::string tool = fs::path(argv[4]).filename().string();
  Random random(13);
  long done = 0, refused = 0, first = 0, otherwise = 0;
  for (long k = 0; k <= count; ++k) {
    const std::string bad = k == 0 ? good : fuzz::mutant(good, random);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bad;
    const int code = run(argv + 4, said);
    if (k == 0) {  // the example itself
      if (code == 0) continue;
      std::fprintf(stderr, "tool_mutants: the valid file ends with exit %d: %s", code,
                   content(said).c_str());
      return 2;
    }
    if (code == 0 || (checks && code == 1)) {
      ++done;
    } else if (code == 3 && well_said(content(said), tool)) {
      ++refused;
    } else {
      if (otherwise++ == 0) first = k;
      const std::string kept = file + "." + std::to_string(k);
      std::ofstream(kept, std::ios::binary) << bad;
      std::ofstream(kept + ".said") << "exit " << code << "\n" << content(said);
    }
  }
  std::printf("%ld %ld %ld %ld\n", done, refused, otherwise, first);
  return otherwise > 0 ? 1 : 0;
}
