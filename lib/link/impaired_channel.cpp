#include "link/impaired_channel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapsim {
namespace {

constexpr double kJitterTime = 0.1;  // [s]

}  // namespace

ImpairedChannel::ImpairedChannel(const Impairment& impairment, std::uint64_t seed,
                                 std::size_t capacity)
    : impairment_(impairment), random_(seed), capacity_(capacity) {
  heap_.reserve(capacity);
}

void ImpairedChannel::push(std::int64_t now, const Datagram& datagram) noexcept {
  const double keep = std::exp(-1e-9 * static_cast<double>(now - pushed_) / kJitterTime);
  pushed_ = now;
  swing_ = keep * swing_ + std::sqrt(1 - keep * keep) * random_.normal();
  if (random_.uniform() < impairment_.loss) return;
  const bool twice = random_.uniform() < impairment_.duplicate;
  for (int copy = 0; copy < (twice ? 2 : 1); ++copy) {
    const bool apart = random_.uniform() < impairment_.reorder;
    const double late = impairment_.jitter * std::abs(apart ? random_.normal() : swing_);
    std::int64_t due = now + std::llround(1e9 * (impairment_.delay + late));
    if (!apart) due = last_ = std::max(due, last_);
    add(due, datagram);
  }
}

void ImpairedChannel::add(std::int64_t due, const Datagram& datagram) noexcept {
  if (heap_.size() == capacity_) return;
  heap_.push_back({due, order_++, datagram});
  std::push_heap(heap_.begin(), heap_.end());
}

bool ImpairedChannel::pop(std::int64_t now, Datagram& datagram) noexcept {
  if (heap_.empty() || heap_.front().due > now) return false;
  datagram = heap_.front().datagram;
  std::pop_heap(heap_.begin(), heap_.end());
  heap_.pop_back();
  return true;
}

std::int64_t ImpairedChannel::next_due() const noexcept {
  return heap_.empty() ? std::numeric_limits<std::int64_t>::max() : heap_.front().due;
}

}  // namespace hapsim
