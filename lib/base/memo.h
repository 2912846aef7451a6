// Values kept under what they were made of, so that they need not be made again.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <utility>

namespace hapsim {

// A value is a function of its key alone: whether it is still here changes time, never a result.
// Holds up to so many values (0: none); the one not asked for longest goes first. Safe for threads.
template <class Key, class Value>
class Memo {
 public:
  explicit Memo(std::size_t capacity) : capacity_(capacity) {}

  // A copy of the value kept under the key; Value{} when there is none.
  Value find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = place_.find(key);
    if (found == place_.end()) return {};
    kept_.splice(kept_.begin(), kept_, found->second);
    return found->second->second;
  }
  // The same, and the caller has it alone until it is put back.
  Value take(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = place_.find(key);
    if (found == place_.end()) return {};
    Value value = std::move(found->second->second);
    kept_.erase(found->second);
    place_.erase(found);
    return value;
  }
  void put(const Key& key, Value value) {
    if (capacity_ == 0) return;
    const std::lock_guard lock(mutex_);
    if (const auto found = place_.find(key); found != place_.end()) {
      found->second->second = std::move(value);
      kept_.splice(kept_.begin(), kept_, found->second);
      return;
    }
    kept_.emplace_front(key, std::move(value));
    place_[key] = kept_.begin();
    if (kept_.size() <= capacity_) return;
    place_.erase(kept_.back().first);
    kept_.pop_back();
  }

 private:
  std::size_t capacity_;
  std::mutex mutex_;
  std::list<std::pair<Key, Value>> kept_;  // the latest first
  std::map<Key, typename std::list<std::pair<Key, Value>>::iterator> place_;
};

}  // namespace hapsim
