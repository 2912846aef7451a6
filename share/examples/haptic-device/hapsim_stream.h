// hs-simulate --live --binary extended as a child process: positions and orientations in, forces
// and torques out, for a device's loop that must not wait. Of this header alone a driver needs to
// know: no library of hapsim is linked.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

struct HapsimPose {
  std::array<double, 3> tip{};   // [m], in the body's frame
  std::array<double, 3> turn{};  // rotation vector of the tool [rad]
};

struct HapsimFeel {
  bool contact = false;
  int beyond = 0;                 // of what the force is beyond, see hs-simulate(1)
  int safety = 0;                 // with --hand: why it is not what was asked for, see hs-safety(7)
  std::array<double, 3> force{};  // of the body on the tool [N]
  std::array<double, 3> torque{};  // about its tip [N m]
};

class HapsimStream {
 public:
  // `arguments`: of hs-simulate apart from --live --binary extended, e.g. {"--body", "body.ply",
  // "--model", "m.csv", "--tool-radius", "0.004"}; for a hand with "--hand" and its limits. Waits
  // until the body is ready. Throws when it cannot be.
  explicit HapsimStream(const std::vector<std::string>& arguments, std::uint32_t tools = 1)
      : tools_(tools), feel_(tools) {
    int there[2], back[2];
    if (pipe(there) != 0 || pipe(back) != 0) throw std::runtime_error("no pipe");
    std::signal(SIGPIPE, SIG_IGN);
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("no process");
    if (child_ == 0) {
      dup2(there[0], 0);
      dup2(back[1], 1);
      for (const int fd : {there[0], there[1], back[0], back[1]}) close(fd);
      std::vector<const char*> words{"hs-simulate", "--live", "--binary", "extended", "-q"};
      for (const std::string& a : arguments) words.push_back(a.c_str());
      words.push_back(nullptr);
      execvp(words[0], const_cast<char* const*>(words.data()));
      _exit(127);
    }
    close(there[0]);
    close(back[1]);
    to_ = there[1];
    from_ = back[0];
    try {
      greet();
    } catch (...) {
      end();
      throw;
    }
    for (const int fd : {to_, from_}) fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
  }
  ~HapsimStream() { end(); }
  HapsimStream(const HapsimStream&) = delete;
  HapsimStream& operator=(const HapsimStream&) = delete;

  // Sends the tools' poses at t [s] and waits for what they feel, at most `timeout` [s]. True:
  // feel() is of these poses. False: hs-simulate is late, and feel() is of the newest poses that
  // were answered; what comes later is taken at the next call. Throws when the child has ended (its
  // message is on standard error); feel() is zero then. About 20 us.
  bool exchange(double t, const std::vector<HapsimPose>& poses, double timeout) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
    if (waiting_ < kMostWaiting) send(t, poses);  // else: it is far behind, and gets no more to do
    for (;;) {
      take();
      if (waiting_ == 0) return true;
      const std::chrono::duration<double> left = until - std::chrono::steady_clock::now();
      if (left.count() <= 0) return false;
      pollfd ready{from_, POLLIN, 0};
      timespec wait{static_cast<time_t>(left.count()), 0};
      wait.tv_nsec = static_cast<long>(1e9 * (left.count() - static_cast<double>(wait.tv_sec)));
      ppoll(&ready, 1, &wait, nullptr);
    }
  }
  const std::vector<HapsimFeel>& feel() const { return feel_; }
  bool ended() const { return ended_; }  // hs-simulate has said zero, for good
  pid_t child() const { return child_; }

 private:
  static constexpr std::uint32_t kVersion = 3, kFirstVersion = 2;
  static constexpr int kEnded = 128, kUnasked = 512;  // bits of `safety`
  static constexpr std::size_t kHeader = 32, kStep = 16, kPose = 80, kFeel = 144;
  static constexpr long kMostWaiting = 64;

  template <class T>
  static void put(std::vector<char>& to, const T& value) {
    const char* from = reinterpret_cast<const char*>(&value);
    to.insert(to.end(), from, from + sizeof value);
  }
  template <class T>
  static T get(const std::vector<char>& from, std::size_t at) {
    T value;
    std::memcpy(&value, from.data() + at, sizeof value);
    return value;
  }

  void greet() {
    out_.assign({'h', 'a', 'p', 's', 'i', 'm', 'I', 'O'});
    const std::uint32_t asked[] = {kVersion, static_cast<std::uint32_t>(kStep + kPose * tools_),
                                   tools_, 0};
    for (const std::uint32_t number : asked) put(out_, number);
    out_.resize(kHeader, 0);
    if (write(to_, out_.data(), kHeader) != static_cast<ssize_t>(kHeader)) fail();
    in_.resize(kHeader);
    for (std::size_t got = 0; got < kHeader;) {
      const ssize_t n = read(from_, in_.data() + got, kHeader - got);
      if (n <= 0) fail();
      got += static_cast<std::size_t>(n);
    }
    // An answer of this version or of an older one; its records may be longer than we know.
    record_ = get<std::uint32_t>(in_, 12);
    const auto version = get<std::uint32_t>(in_, 8);
    if (std::memcmp(in_.data(), "hapsimIO", 8) != 0 || version < kFirstVersion ||
        version > kVersion || record_ < kStep + kFeel * tools_)
      throw std::runtime_error("hs-simulate speaks another version");
    in_.clear();
  }

  void send(double t, const std::vector<HapsimPose>& poses) {
    out_.clear();
    put(out_, t);
    put(out_, std::numeric_limits<double>::quiet_NaN());  // no temperature
    for (const HapsimPose& pose : poses) {
      put(out_, std::int32_t{1});
      put(out_, std::int32_t{1});
      put(out_, pose.tip);
      put(out_, std::array<double, 3>{});
      put(out_, pose.turn);
    }
    const ssize_t n = write(to_, out_.data(), out_.size());  // whole: shorter than PIPE_BUF
    if (n == static_cast<ssize_t>(out_.size()))
      ++waiting_;
    else if (n >= 0 || errno != EAGAIN)
      lose();
  }

  // All that has come.
  void take() {
    for (;;) {
      const std::size_t had = in_.size();
      in_.resize(record_);
      const ssize_t n = read(from_, in_.data() + had, record_ - had);
      if (n <= 0) {
        in_.resize(had);
        if (n < 0 && errno == EAGAIN) return;
        lose();
      }
      in_.resize(had + static_cast<std::size_t>(n));
      if (in_.size() < record_) continue;
      int safety = 0;
      for (std::uint32_t k = 0; k < tools_; ++k) {
        const std::size_t at = kStep + kFeel * k;
        feel_[k].contact = get<std::int32_t>(in_, at + 4) != 0;
        feel_[k].beyond = get<std::int32_t>(in_, at + 8);
        safety |= feel_[k].safety = get<std::int32_t>(in_, at + 12);
        feel_[k].force = get<std::array<double, 3>>(in_, at + 88);
        feel_[k].torque = get<std::array<double, 3>>(in_, at + 112);
      }
      in_.clear();
      ended_ = ended_ || (safety & kEnded) != 0;
      if ((safety & (kUnasked | kEnded)) == 0)
        --waiting_;  // else it came of its own, for want of poses
    }
  }

  // A child that does not end within a second, because it is stopped, is killed.
  void end() {
    close(to_);
    close(from_);
    for (int ms = 0; ms < 1000 && waitpid(child_, nullptr, WNOHANG) == 0; ++ms) {
      const timespec wait{0, 1'000'000};
      nanosleep(&wait, nullptr);
      if (ms == 999) {
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
      }
    }
  }
  [[noreturn]] void lose() {
    for (HapsimFeel& feel : feel_) feel = {};
    fail();
  }
  [[noreturn]] static void fail() { throw std::runtime_error("hs-simulate has ended"); }

  std::uint32_t tools_;
  std::vector<HapsimFeel> feel_;
  std::vector<char> out_, in_;
  std::size_t record_ = 0;
  long waiting_ = 0;  // poses that are not answered yet
  bool ended_ = false;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
};

// What a late force is worth: all of it at first, and nothing once it is too old.
class LateForce {
 public:
  LateForce(double hold, double fade) : hold_(hold), fade_(fade) {}  // [s]
  // Factor of the newest force at time t [s], `fresh` where it is of this time's poses.
  double factor(double t, bool fresh) {
    if (fresh) last_ = t;
    return std::clamp(1 - (t - last_ - hold_) / fade_, 0.0, 1.0);
  }

 private:
  double hold_, fade_, last_ = -1e9;
};
