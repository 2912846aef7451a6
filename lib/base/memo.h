// Values kept under what they were made of, so that they need not be made again.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <typeindex>
#include <utility>

#include "base/held_bytes.h"

namespace hapsim {

// A value is a function of its type and key alone: whether it is still here changes time, never a
// result. Values of any type share one budget of bytes (0: none is kept); the one not asked for
// longest goes first. What somebody still holds when it goes is no longer counted. Safe for
// threads.
class Memo {
 public:
  // What a contact's matrix takes (some 40 MB) twenty-five times over.
  static constexpr std::size_t kDefaultBudget = 1'000'000'000;

  explicit Memo(std::size_t budget = kDefaultBudget) : budget_(budget) {}

  // The value kept under the key; null when there is none.
  template <class Value>
  std::shared_ptr<const Value> find(const std::string& key) {
    return std::static_pointer_cast<const Value>(find({typeid(Value), key}));
  }
  // The same, and the memo gives it up: the caller may change it and put it back.
  template <class Value>
  std::shared_ptr<Value> take(const std::string& key) {
    return std::static_pointer_cast<Value>(take({typeid(Value), key}));
  }
  // What it holds then counts as held_bytes() says now: only what was taken may still change.
  template <class Value>
  void put(const std::string& key, std::shared_ptr<Value> value) {
    const std::size_t bytes = size_of(key, *value);
    put({typeid(Value), key}, constant_cast(std::move(value)), bytes, true);
  }
  // Where others need not go for it. A round through more values than there is room for then finds
  // some of them each time, where putting would find none.
  template <class Value>
  void put_if_room(const std::string& key, std::shared_ptr<Value> value) {
    const std::size_t bytes = size_of(key, *value);
    put({typeid(Value), key}, constant_cast(std::move(value)), bytes, false);
  }

  std::size_t budget() const { return budget_; }
  std::size_t bytes() const;  // of what is kept; never above the budget

 private:
  using Key = std::pair<std::type_index, std::string>;
  struct Entry {
    Key key;
    std::shared_ptr<void> value;
    std::size_t bytes;
  };
  using Entries = std::list<Entry>;

  template <class Value>
  static std::shared_ptr<void> constant_cast(std::shared_ptr<Value> value) {
    return std::const_pointer_cast<std::remove_const_t<Value>>(std::move(value));
  }
  template <class Value>
  static std::size_t size_of(const std::string& key, const Value& value) {
    return sizeof(Value) + held_bytes(value) + 2 * held_bytes(key) + kOverhead;
  }
  // Of an entry: its nodes in the list and in the map.
  static constexpr std::size_t kOverhead = sizeof(Entry) + sizeof(Key) + 96;

  std::shared_ptr<void> find(const Key& key);
  std::shared_ptr<void> take(const Key& key);
  void put(Key key, std::shared_ptr<void> value, std::size_t bytes, bool others_go);
  void remove(Entries::iterator entry, Entries& gone);

  const std::size_t budget_;
  mutable std::mutex mutex_;
  std::size_t bytes_ = 0;
  Entries entries_;  // the latest first
  std::map<Key, Entries::iterator> place_;
};

}  // namespace hapsim
