// How long the samples of a loop took: counted without allocation, told as shares.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace hapsim {

// A histogram of durations in bins of 1/32 of a power of two: read back to 3 %, 1 ns to 36 minutes.
class LatencyHistogram {
 public:
  void add(std::int64_t nanoseconds) noexcept;
  std::int64_t count() const { return count_; }
  std::int64_t largest() const { return largest_; }  // [ns]
  // The least duration that this share of the samples does not exceed [ns]; 0 without samples.
  std::int64_t quantile(double share) const;
  // "1000 samples: median 0.21 us, 99 % 0.4 us, 99.9 % ..., 99.99 % ..., longest ...".
  std::string summary() const;

 private:
  static constexpr int kSub = 32, kOctaves = 36;
  std::array<std::int64_t, (kOctaves + 1)* kSub> bin_ = {};
  std::int64_t count_ = 0, largest_ = 0;
};

}  // namespace hapsim
