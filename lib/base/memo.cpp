#include "base/memo.h"

namespace hapsim {

std::size_t Memo::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::shared_ptr<void> Memo::find(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto found = place_.find(key);
  if (found == place_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->value;
}

std::shared_ptr<void> Memo::take(const Key& key) {
  Entries gone;
  const std::lock_guard lock(mutex_);
  const auto found = place_.find(key);
  if (found == place_.end()) return nullptr;
  remove(found->second, gone);
  return std::move(gone.front().value);
}

void Memo::put(Key key, std::shared_ptr<void> value, std::size_t bytes, bool others_go) {
  Entries gone;  // ends outside of the lock
  const std::lock_guard lock(mutex_);
  if (const auto known = place_.find(key); known != place_.end()) remove(known->second, gone);
  if (bytes > budget_ || (!others_go && bytes > budget_ - bytes_)) return;
  while (bytes > budget_ - bytes_) remove(std::prev(entries_.end()), gone);
  entries_.push_front({std::move(key), std::move(value), bytes});
  place_[entries_.front().key] = entries_.begin();
  bytes_ += bytes;
}

void Memo::remove(Entries::iterator entry, Entries& gone) {
  bytes_ -= entry->bytes;
  place_.erase(entry->key);
  gone.splice(gone.begin(), entries_, entry);
}

}  // namespace hapsim
