// A program run to its end, with what it took.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace hapsim::bench {

struct Run {  // seconds of the processor, largest memory
  double seconds = 1e300, megabytes = 0;
  bool done = false;
};

// In `folder`; the least of `runs`.
inline Run run_whole(const std::filesystem::path& folder, const std::vector<std::string>& command,
                     int runs) {
  Run best;
  for (int i = 0; i < runs; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
      if (chdir(folder.c_str()) != 0) _exit(126);
      setenv("OMP_NUM_THREADS", "1", 1);
      std::vector<char*> words;
      for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
      words.push_back(nullptr);
      execvp(words[0], words.data());
      _exit(127);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    double seconds = 0;
    for (const timeval& t : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    best.done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    best.seconds = std::min(best.seconds, seconds);
    best.megabytes = std::max(best.megabytes, static_cast<double>(used.ru_maxrss) / 1024);
  }
  return best;
}

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace hapsim::bench
