// How much memory a value holds: what a Memo is bounded by.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace hapsim {

// held_bytes(value): bytes on the heap that a value holds, itself not counted. A type of ours says
// it by a member held_bytes() or by a function of its own; one that is trivially destructible holds
// none. What a value only refers to is not its own.
template <class T>
requires requires(const T& value) {
  value.held_bytes();
}
std::size_t held_bytes(const T& value) {
  return value.held_bytes();
}

template <class T>
requires std::is_trivially_destructible_v<T> std::size_t held_bytes(const T&) {
  return 0;
}

inline std::size_t held_bytes(const std::string& text) {
  return text.capacity() < sizeof(std::string) / 2 ? 0 : text.capacity() + 1;
}

template <class Matrix>
requires(!std::is_trivially_destructible_v<Matrix>) std::size_t
    held_bytes(const Eigen::PlainObjectBase<Matrix>& matrix) {
  return static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar);
}

// Counted by each that shares it.
template <class T>
std::size_t held_bytes(const std::shared_ptr<T>& value) {
  return value ? sizeof(T) + held_bytes(*value) : 0;
}

template <class T>
std::size_t held_bytes(const std::unique_ptr<T>& value) {
  return value ? sizeof(T) + held_bytes(*value) : 0;
}

template <class T>
std::size_t held_bytes(const std::vector<T>& values) {
  std::size_t sum = values.capacity() * sizeof(T);
  if constexpr (!std::is_trivially_destructible_v<T>)
    for (const T& value : values) sum += held_bytes(value);
  return sum;
}

}  // namespace hapsim
