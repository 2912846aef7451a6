#include "realtime/motion_feed.h"

#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "io/system_error.h"

namespace hapsim {
namespace {

// Interrupts a read and does nothing else.
constexpr int kWake = SIGUSR2;
extern "C" void wake(int) {}

// Of the calling thread.
void mask_signals(int how) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(how, &set, nullptr);
}

}  // namespace

template <class Source, class Item>
Feed<Source, Item>::Feed(Source& source, const Input& input, std::size_t capacity)
    : input_(input), ring_(capacity) {
  event_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (event_ < 0) fail_system("motion", "cannot be waited for", errno);
  struct sigaction action = {};
  action.sa_handler = wake;
  sigaction(kWake, &action, nullptr);
  thread_ = std::thread([this, &source] { run(source); });
  mask_signals(SIG_BLOCK);
}

template <class Source, class Item>
Feed<Source, Item>::~Feed() {
  stop_ = true;
  // A read that waits is ended as a signal would end it. Where one has, in whatever thread, another
  // would end the process: then the read is woken alone, to find its input at the end.
  if (!has_ended() && !input_.ended_by_signal()) pthread_kill(thread_.native_handle(), SIGTERM);
  for (; !has_ended(); std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    if (input_.ended_by_signal()) pthread_kill(thread_.native_handle(), kWake);
  thread_.join();
  mask_signals(SIG_UNBLOCK);
  close(event_);
}

template <class Source, class Item>
void Feed<Source, Item>::run(Source& source) {
  const auto tell = [this] {
    const std::uint64_t one = 1;
    if (write(event_, &one, sizeof one) < 0) {
      // Full: it is readable already.
    }
  };
  try {
    for (Item item; !stop_ && source.next(item); tell())
      while (!ring_.push(item) && !stop_)
        std::this_thread::sleep_for(std::chrono::microseconds(500));
  } catch (...) {
    thrown_ = std::current_exception();
  }
  ended_.store(true, std::memory_order_release);
  tell();
}

template <class Source, class Item>
bool Feed<Source, Item>::take(Item& item) {
  const bool ended = has_ended();  // asked first: what came before the end is in the ring by then
  if (ring_.pop(item)) return true;
  if (ended && thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  return false;
}

template <class Source, class Item>
void Feed<Source, Item>::require_sound() const {
  if (has_ended() && thrown_) std::rethrow_exception(thrown_);
}

template <class Source, class Item>
void Feed<Source, Item>::clear_event() noexcept {
  std::uint64_t count = 0;
  if (read(event_, &count, sizeof count) < 0) {
    // Nothing has come.
  }
}

template class Feed<MotionSource, MotionLine>;
template class Feed<ToolSource, ToolStep>;

}  // namespace hapsim
