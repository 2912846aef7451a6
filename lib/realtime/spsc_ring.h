// A queue between two threads, one that writes and one that reads, without locks.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace hapsim {

// All memory is taken at the start (Lamport, ACM Trans. Programming Languages 5, 1983).
template <class T>
class SpscRing {
 public:
  explicit SpscRing(std::size_t capacity) : slot_(capacity + 1) {}
  // By the writer: false when it is full.
  bool push(const T& value) noexcept {
    const std::size_t at = write_.load(std::memory_order_relaxed), next = (at + 1) % slot_.size();
    if (next == read_.load(std::memory_order_acquire)) return false;
    slot_[at] = value;
    write_.store(next, std::memory_order_release);
    return true;
  }
  // By the reader: false when it is empty.
  bool pop(T& value) noexcept {
    const std::size_t at = read_.load(std::memory_order_relaxed);
    if (at == write_.load(std::memory_order_acquire)) return false;
    value = slot_[at];
    read_.store((at + 1) % slot_.size(), std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> slot_;
  std::atomic<std::size_t> write_{0}, read_{0};
};

}  // namespace hapsim
