// Numbers as bytes, little-endian, and back.
#pragma once

#include <bit>
#include <cstring>
#include <span>

#include "base/vec3.h"

namespace hapsim {

static_assert(std::endian::native == std::endian::little, "what is sent is little-endian");

template <class T>
void put(unsigned char*& at, const T& value) noexcept {
  std::memcpy(at, &value, sizeof value);
  at += sizeof value;
}
inline void put_vector(unsigned char*& at, const Vec3& v) noexcept {
  for (int k = 0; k < 3; ++k) put(at, v[k]);
}
template <class T>
T take(const unsigned char*& at) noexcept {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}
inline Vec3 take_vector(const unsigned char*& at) noexcept {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = take<double>(at);
  return v;
}

}  // namespace hapsim
