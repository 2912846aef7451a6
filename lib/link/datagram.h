// What goes over the network at once.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace hapsim {

using Bytes = std::span<const unsigned char>;

struct Datagram {
  static constexpr std::size_t kMost = 256;
  std::array<unsigned char, kMost> bytes{};
  std::size_t size = 0;

  Datagram() = default;
  explicit Datagram(Bytes from) : size(std::min(from.size(), kMost)) {
    std::copy_n(from.begin(), size, bytes.begin());
  }
  Bytes view() const { return {bytes.data(), size}; }
};

}  // namespace hapsim
