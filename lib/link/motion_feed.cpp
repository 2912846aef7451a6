#include "link/motion_feed.h"

#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "io/system_error.h"

namespace hapsim {
namespace {

// Of the calling thread.
void mask_signals(int how) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(how, &set, nullptr);
}

}  // namespace

MotionFeed::MotionFeed(MotionSource& source, std::size_t capacity) : ring_(capacity) {
  event_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (event_ < 0) fail_system("motion", "cannot be waited for", errno);
  thread_ = std::thread([this, &source] { run(source); });
  mask_signals(SIG_BLOCK);
}

MotionFeed::~MotionFeed() {
  stop_ = true;
  // A read that waits is ended as a signal would end it (Input::end_on_signals()).
  for (const int signal : {SIGTERM, SIGINT}) {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (has_ended() || action.sa_handler == SIG_IGN || action.sa_handler == SIG_DFL) continue;
    pthread_kill(thread_.native_handle(), signal);
    break;
  }
  thread_.join();
  mask_signals(SIG_UNBLOCK);
  close(event_);
}

void MotionFeed::run(MotionSource& source) {
  const auto tell = [this] {
    const std::uint64_t one = 1;
    if (write(event_, &one, sizeof one) < 0) {
      // Full: it is readable already.
    }
  };
  try {
    for (MotionLine line; !stop_ && source.next(line); tell())
      while (!ring_.push(line) && !stop_)
        std::this_thread::sleep_for(std::chrono::microseconds(500));
  } catch (...) {
    thrown_ = std::current_exception();
  }
  ended_.store(true, std::memory_order_release);
  tell();
}

bool MotionFeed::take(MotionLine& line) {
  const bool ended = has_ended();  // asked first: what came before the end is in the ring by then
  if (ring_.pop(line)) return true;
  if (ended && thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  return false;
}

void MotionFeed::clear_event() noexcept {
  std::uint64_t count = 0;
  if (read(event_, &count, sizeof count) < 0) {
    // Nothing has come.
  }
}

}  // namespace hapsim
