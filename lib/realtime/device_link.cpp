#include "realtime/device_link.h"

#include <algorithm>
#include <cassert>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

// Samples that may be on their way: of a loop that is late by more, new ones are dropped.
constexpr std::size_t kOnTheirWay = 64;

}  // namespace

DeviceLink::DeviceLink(SeveralTools& tools)
    : tools_(tools), asked_(kOnTheirWay), answered_(kOnTheirWay), thread_([this] { answer(); }) {}

DeviceLink::~DeviceLink() {
  ends_.store(true, std::memory_order_relaxed);
  thread_.join();
}

void DeviceLink::answer() noexcept {
  Asked asked;
  Answered answered;
  while (!ends_.load(std::memory_order_relaxed)) {
    bool any = false;
    while (asked_.pop(asked)) any = true;
    if (!any) {
      std::this_thread::yield();
      continue;
    }
    const auto feel = tools_.step(asked.t, {asked.pose.data(), tools_.tools()});
    std::copy(feel.begin(), feel.end(), answered.feel.begin());
    answered.number = asked.number;
    answered_.push(answered);  // full: the device does not ask for answers; the next one will do
  }
}

std::uint64_t DeviceLink::exchange(double t, std::span<const ToolPose> poses,
                                   std::span<ToolFeel> feel, std::int64_t timeout) noexcept {
  assert(poses.size() == tools_.tools() && feel.size() == tools_.tools());
  const std::int64_t until = monotonic_ns() + timeout;
  asking_.t = t;
  std::copy(poses.begin(), poses.end(), asking_.pose.begin());
  ++asking_.number;
  const bool sent = asked_.push(asking_);
  do {
    while (answered_.pop(newest_)) {
    }
  } while (sent && newest_.number != asking_.number && monotonic_ns() < until);
  std::copy(newest_.feel.begin(), newest_.feel.begin() + static_cast<std::ptrdiff_t>(feel.size()),
            feel.begin());
  return newest_.number == 0 ? kNever : asking_.number - newest_.number;
}

}  // namespace hapsim
