// A value that is dear to make and that many runs never ask for.
#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace hapsim {

// Made by the first who asks; who asks next gets the same. `make` must always make the same value:
// when it is asked for changes time, never a result. Safe for threads; one that throws has made
// nothing.
template <class Value>
class MadeOnce {
 public:
  template <class Make>
  const Value& get(Make make) const {
    std::call_once(once_, [&] { value_.emplace(make()); });
    return *value_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<Value> value_;
};

}  // namespace hapsim
