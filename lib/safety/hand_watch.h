// Says what a hand gets while the loop that should answer does not.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "realtime/real_time.h"

namespace hapsim {

// A thread that calls `overdue` about every millisecond while what was asked is not answered for
// longer than `hold` [s], or at once where `is_ended`. Who answers holds the lock meanwhile.
class HandWatch {
 public:
  HandWatch(double hold, std::function<bool()> is_ended, std::function<void()> overdue)
      : hold_(static_cast<std::int64_t>(1e9 * hold)),
        is_ended_(std::move(is_ended)),
        overdue_(std::move(overdue)),
        thread_([this] { run(); }) {}
  ~HandWatch() {
    stop_ = true;
    thread_.join();
  }
  HandWatch(const HandWatch&) = delete;
  HandWatch& operator=(const HandWatch&) = delete;

  void asked(std::int64_t now) noexcept { asked_.store(now, std::memory_order_release); }
  std::int64_t when_asked() const noexcept { return asked_.load(std::memory_order_relaxed); }
  // From here on `overdue` does not run until something is asked again.
  std::unique_lock<std::mutex> answer() {
    std::unique_lock<std::mutex> lock(mutex_);
    asked_.store(0, std::memory_order_relaxed);
    return lock;
  }

 private:
  bool is_overdue() const {
    const std::int64_t asked = asked_.load(std::memory_order_acquire);
    return asked != 0 && (monotonic_ns() - asked > hold_ || is_ended_());
  }
  void run() {
    for (; !stop_; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      if (!is_overdue()) continue;
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_overdue()) overdue_();
    }
  }

  std::int64_t hold_;
  std::function<bool()> is_ended_;
  std::function<void()> overdue_;
  std::mutex mutex_;
  std::atomic<std::int64_t> asked_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace hapsim
