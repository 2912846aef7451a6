#include "tetmesh/process_spawner.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <utility>

#include "base/byte_stream.h"
#include "base/error.h"

namespace hapsim {
namespace {

constexpr int kControl = 3;  // where the spawner has its socket, beside the standard streams

// Ends of the worker's stream and of the one for its status.
struct Ends {
  std::array<int, 2> file{-1, -1};
};

// A byte that carries them from process to process.
class Parcel {
 public:
  Parcel() {
    message_.msg_iov = &part_;
    message_.msg_iovlen = 1;
    message_.msg_control = control_;
    message_.msg_controllen = sizeof control_;
  }
  Parcel(const Parcel&) = delete;

  bool send(int socket, const Ends& ends) {
    cmsghdr* head = CMSG_FIRSTHDR(&message_);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof ends.file);
    std::memcpy(CMSG_DATA(head), ends.file.data(), sizeof ends.file);
    ssize_t sent;
    do sent = sendmsg(socket, &message_, MSG_NOSIGNAL);
    while (sent < 0 && errno == EINTR);
    return sent == 1;
  }

  // False when the other side is gone.
  bool receive(int socket, Ends& ends) {
    ssize_t got;
    do got = recvmsg(socket, &message_, 0);
    while (got < 0 && errno == EINTR);
    const cmsghdr* head = got == 1 ? CMSG_FIRSTHDR(&message_) : nullptr;
    if (head == nullptr || head->cmsg_len != CMSG_LEN(sizeof ends.file)) return false;
    std::memcpy(ends.file.data(), CMSG_DATA(head), sizeof ends.file);
    return true;
  }

 private:
  char byte_ = 0;
  iovec part_{&byte_, 1};
  msghdr message_{};
  alignas(cmsghdr) char control_[CMSG_SPACE(sizeof(Ends::file))]{};
};

int status_of(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// The keepers that have ended, so that their time counts as that of our parent's children.
void take_ended() {
  while (waitpid(-1, nullptr, WNOHANG) > 0) {
  }
}

// Killed when the parent ends, also by an end that came before this was asked for.
void end_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
}

// Between spawner and worker: says the worker's number, then how it ended.
[[noreturn]] void keep_worker(const Ends& ends, ProcessSpawner::Work work, pid_t spawner) {
  end_with(spawner);
  const pid_t keeper = getpid(), worker = fork();
  if (worker == 0) {
    end_with(keeper);
    close(ends.file[1]);
    for (const int number : {SIGPIPE, SIGTERM, SIGINT, SIGHUP}) signal(number, SIG_DFL);
    work(ends.file[0]);
    _exit(1);
  }
  close(ends.file[0]);
  const ByteStream parent(ends.file[1]);
  if (worker < 0 || !parent.put(&worker, sizeof worker)) _exit(1);
  const int status = status_of(worker);
  _exit(parent.put(&status, sizeof status) ? 0 : 1);
}

[[noreturn]] void serve(int control, ProcessSpawner::Work work) {
  // The parent's handlers are not for us, and its end is what ends us.
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGXCPU})
    signal(number, SIG_DFL);
  for (const int number : {SIGPIPE, SIGTERM, SIGINT, SIGHUP}) signal(number, SIG_IGN);
  signal(SIGCHLD, SIG_DFL);
  // None of its files, or who waits for their end would wait for ours.
  if (control != kControl) dup2(control, kControl);
  closefrom(kControl + 1);
  const int nowhere = open("/dev/null", O_RDWR);
  for (int stream = 0; stream < kControl; ++stream) dup2(nowhere, stream);
  close(nowhere);
  const pid_t spawner = getpid();
  for (Ends ends; Parcel().receive(kControl, ends);) {
    if (fork() == 0) {
      close(kControl);
      keep_worker(ends, work, spawner);
    }
    for (const int file : ends.file) close(file);
    take_ended();
  }
  take_ended();
  _exit(0);
}

// Within so many seconds.
bool is_readable(int file, double patience) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  for (;;) {
    const std::chrono::duration<double, std::milli> left = end - std::chrono::steady_clock::now();
    pollfd watched{file, POLLIN, 0};
    const int found = poll(&watched, 1, static_cast<int>(std::max(left.count(), 0.0)));
    if (found >= 0 || errno != EINTR) return found > 0;
  }
}

[[noreturn]] void no_process(const char* what) {
  throw Error(ExitCode::kIo, "TetGen", std::string(what) + std::strerror(errno),
              "close other programs");
}

}  // namespace

Worker::Worker(Worker&& other) noexcept
    : data_(std::exchange(other.data_, -1)),
      told_(std::exchange(other.told_, -1)),
      process_(other.process_) {}

Worker::~Worker() {
  finish(false);
}

int Worker::finish(bool ended) {
  if (data_ < 0) return 0;
  close(std::exchange(data_, -1));
  // Its status has not been read, so it is there, or was until this moment.
  if (!ended) kill(process_, SIGKILL);
  int status = SIGKILL;  // of one whose keeper was killed too
  ByteStream(told_).get(&status, sizeof status);
  close(told_);
  return status;
}

ProcessSpawner::ProcessSpawner(Work work) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) no_process("no socket: ");
  process_ = fork();
  if (process_ == 0) serve(ends[1], work);
  close(ends[1]);
  control_ = ends[0];
  if (process_ < 0) {
    close(control_);
    no_process("no process: ");
  }
}

ProcessSpawner::~ProcessSpawner() {
  close(control_);
  for (int i = 0; i < 100; ++i) {
    if (waitpid(process_, nullptr, WNOHANG) != 0) return;
    usleep(2'000);
  }
  kill(process_, SIGKILL);  // it waits for a lock
  status_of(process_);
}

std::optional<Worker> ProcessSpawner::spawn(double patience) {
  int data[2], status[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, data) != 0) no_process("no socket: ");
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, status) != 0) {
    for (const int file : data) close(file);
    no_process("no socket: ");
  }
  const bool sent = Parcel().send(control_, {{data[1], status[1]}});
  close(data[1]);
  close(status[1]);
  pid_t worker;
  if (sent && is_readable(status[0], patience) && ByteStream(status[0]).get(&worker, sizeof worker))
    return Worker(data[0], status[0], worker);
  close(data[0]);
  close(status[0]);
  return std::nullopt;
}

}  // namespace hapsim
