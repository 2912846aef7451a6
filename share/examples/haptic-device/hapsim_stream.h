// hs-simulate --live --binary tip as a child process: positions in, forces out, for a device's
// loop. Of this header alone a driver needs to know: no library of hapsim is linked.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

class HapsimStream {
 public:
  // `arguments`: of hs-simulate apart from --live --binary tip, e.g. {"--body", "body.ply",
  // "--model", "m.csv", "--tool-radius", "0.004"}.
  explicit HapsimStream(const std::vector<std::string>& arguments) {
    int there[2], back[2];
    if (pipe(there) != 0 || pipe(back) != 0) throw std::runtime_error("no pipe");
    std::signal(SIGPIPE, SIG_IGN);
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("no process");
    if (child_ == 0) {
      dup2(there[0], 0);
      dup2(back[1], 1);
      for (const int fd : {there[0], there[1], back[0], back[1]}) close(fd);
      std::vector<const char*> words{"hs-simulate", "--live", "--binary", "tip", "-q"};
      for (const std::string& a : arguments) words.push_back(a.c_str());
      words.push_back(nullptr);
      execvp(words[0], const_cast<char* const*>(words.data()));
      _exit(127);
    }
    close(there[0]);
    close(back[1]);
    to_ = there[1];
    from_ = back[0];
  }
  ~HapsimStream() {
    close(to_);
    close(from_);
    waitpid(child_, nullptr, 0);
  }
  HapsimStream(const HapsimStream&) = delete;
  HapsimStream& operator=(const HapsimStream&) = delete;

  // The force on the tool [N] at a position of its tip [m], t [s]; about 20 us. Throws when the
  // child has ended (its message is on standard error).
  std::array<double, 3> force(double t, const std::array<double, 3>& tip) {
    const std::array<double, 4> in{t, tip[0], tip[1], tip[2]};
    if (write(to_, in.data(), sizeof in) != static_cast<ssize_t>(sizeof in)) fail();
    std::array<char, 88> out;
    for (std::size_t got = 0; got < out.size();) {
      const ssize_t n = read(from_, out.data() + got, out.size() - got);
      if (n <= 0) fail();
      got += static_cast<std::size_t>(n);
    }
    std::array<double, 3> f;
    std::memcpy(f.data(), out.data() + 64, sizeof f);  // after press, contact, t, x y z, ux uy uz
    return f;
  }

 private:
  [[noreturn]] static void fail() { throw std::runtime_error("hs-simulate has ended"); }
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
};
