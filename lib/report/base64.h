// Arrays as text inside a page.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hapsim {

std::string base64(const void* data, std::size_t size);

template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

}  // namespace hapsim
