#include "cli/interrupt.h"

#include <signal.h>

#include <array>
#include <atomic>
#include <cerrno>

namespace hapsim {
namespace {

constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};

std::atomic<bool> asked_for{false};
std::array<struct sigaction, kSignals.size()> before;
static_assert(std::atomic<bool>::is_always_lock_free);

void restore() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
}

extern "C" void take_note(int) {
  const int saved = errno;
  asked_for.store(true);
  restore();
  errno = saved;
}

}  // namespace

Interrupt::Interrupt() {
  asked_for.store(false);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], nullptr, &before[i]);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action = {};
    action.sa_handler = take_note;
    action.sa_flags = SA_RESTART;
    sigaction(kSignals[i], &action, nullptr);
  }
}

Interrupt::~Interrupt() {
  restore();
}

bool Interrupt::asked() const {
  return asked_for.load();
}

}  // namespace hapsim
