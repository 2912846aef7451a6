#include "io/interrupt.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <thread>

#include "io/system_error.h"

namespace hapsim {
namespace {

constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};

std::atomic<bool> asked_for{false};
std::atomic<int> ended{-1},
    empty{-1};               // descriptors: the input that is ended, what takes its place
std::atomic<int> noting{0};  // threads in take_note(): any may get the signal, a library's too
std::array<struct sigaction, kSignals.size()> before;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void restore() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
}

extern "C" void take_note(int) {
  const int saved = errno;
  noting.fetch_add(1);
  asked_for.store(true);
  if (ended.load() >= 0) dup2(empty.load(), ended.load());
  restore();
  noting.fetch_sub(1);
  errno = saved;
}

void install(int flags) {
  asked_for.store(false);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], nullptr, &before[i]);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action = {};
    action.sa_handler = take_note;
    action.sa_flags = flags;
    sigaction(kSignals[i], &action, nullptr);
  }
}

}  // namespace

Interrupt::Interrupt() {
  install(SA_RESTART);
}

Interrupt::Interrupt(int input, const std::string& name) {
  const int null = uninterrupted([] { return open("/dev/null", O_RDONLY | O_CLOEXEC); });
  if (null < 0) fail_system(name, "cannot be ended by signals", errno);
  empty.store(null);
  ended.store(input);
  install(0);  // the read that waits is to be made again
}

Interrupt::~Interrupt() {
  restore();
  ended.store(-1);
  // Who comes from here on ends nothing; who is at it needs the descriptors.
  while (noting.load() > 0) std::this_thread::yield();
  if (const int null = empty.exchange(-1); null >= 0) close(null);
}

bool Interrupt::asked() const {
  return asked_for.load();
}

}  // namespace hapsim
