#include "realtime/latency.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace hapsim {

void LatencyHistogram::add(std::int64_t nanoseconds) noexcept {
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(nanoseconds, 0));
  // Below kSub one bin a nanosecond; above, the five bits after the leading one.
  std::size_t bin = ns;
  if (ns >= kSub) {
    const int octave = std::bit_width(ns) - 6;
    bin = static_cast<std::size_t>(kSub * octave) + (ns >> octave);
  }
  ++bin_[std::min(bin, bin_.size() - 1)];
  ++count_;
  largest_ = std::max(largest_, static_cast<std::int64_t>(ns));
}

std::int64_t LatencyHistogram::quantile(double share) const {
  const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
  std::int64_t seen = 0;
  for (std::size_t bin = 0; bin < bin_.size(); ++bin) {
    seen += bin_[bin];
    if (seen < wanted || seen == 0) continue;
    if (bin < kSub) return static_cast<std::int64_t>(bin);
    const std::size_t octave = bin / kSub - 1, within = bin % kSub + kSub;
    return std::min(static_cast<std::int64_t>(((within + 1) << octave) - 1), largest_);
  }
  return largest_;
}

std::string LatencyHistogram::summary() const {
  if (count_ == 0) return "no samples";
  const auto us = [](std::int64_t ns) {
    return fmt::format("{:.3g} us", 1e-3 * static_cast<double>(ns));
  };
  return fmt::format("{} samples: median {}, 99 % {}, 99.9 % {}, 99.99 % {}, longest {}", count_,
                     us(quantile(0.5)), us(quantile(0.99)), us(quantile(0.999)),
                     us(quantile(0.9999)), us(largest_));
}

}  // namespace hapsim
