// Numbers that are taken once (RFC 6479): the newest, and those not far behind it.
#pragma once

#include <array>
#include <cstdint>

namespace hapsim {

class ReplayWindow {
 public:
  static constexpr std::uint64_t kBehind = 1024;

  // Whether it could be taken: not too old, not taken yet, not 0.
  bool is_new(std::uint64_t number) const noexcept {
    if (number == 0) return false;
    if (number > newest_) return true;
    return newest_ - number < kBehind && (words_[word(number)] >> (number & 63) & 1) == 0;
  }
  void take(std::uint64_t number) noexcept {
    if (number > newest_) {
      // The words that come into the window are of numbers long past.
      const std::uint64_t from = newest_ / 64, to = number / 64;
      for (std::uint64_t w = 1; w <= to - from && w <= kWords; ++w) words_[(from + w) % kWords] = 0;
      newest_ = number;
    }
    words_[word(number)] |= std::uint64_t{1} << (number & 63);
  }
  std::uint64_t newest() const { return newest_; }

 private:
  static constexpr std::size_t kWords = kBehind / 64 + 1;
  static std::size_t word(std::uint64_t number) { return number / 64 % kWords; }
  std::uint64_t newest_ = 0;
  std::array<std::uint64_t, kWords> words_{};
};

}  // namespace hapsim
