#include "io/input_signals.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>

#include "io/system_error.h"

namespace hapsim {
namespace {

constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};

std::atomic<bool> signalled{false};
std::atomic<int> input{-1}, empty{-1};
std::array<struct sigaction, kSignals.size()> before;
static_assert(std::atomic<int>::is_always_lock_free);

void restore() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
}

extern "C" void end_input(int) {
  const int saved = errno;
  signalled.store(true);
  if (input.load() >= 0) dup2(empty.load(), input.load());
  restore();
  errno = saved;
}

}  // namespace

InputSignals::InputSignals(int fd, const char* name) {
  signalled.store(false);
  const int null = uninterrupted([] { return open("/dev/null", O_RDONLY | O_CLOEXEC); });
  if (null < 0) fail_system(name, "cannot be ended by signals", errno);
  empty.store(null);
  input.store(fd);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], nullptr, &before[i]);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action = {};
    action.sa_handler = end_input;  // no SA_RESTART: what waits for input is to be interrupted
    sigaction(kSignals[i], &action, nullptr);
  }
}

InputSignals::~InputSignals() {
  restore();
  input.store(-1);
  close(empty.exchange(-1));
}

bool InputSignals::came() {
  return signalled.load();
}

}  // namespace hapsim
