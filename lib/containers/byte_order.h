// Between little and big endian.
#pragma once

#include <cstring>
#include <utility>

namespace hapsim {

// Reverses the bytes of a value.
template <class T>
void swap_bytes(T& value) {
  unsigned char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  std::memcpy(&value, bytes, sizeof(T));
}

}  // namespace hapsim
