#include "safety/safe_device.h"

#include <algorithm>

#include "realtime/real_time.h"

namespace hapsim {

std::uint64_t SafeDevice::exchange(double t, std::span<const ToolPose> poses,
                                   std::span<ToolFeel> feel, std::int64_t timeout) noexcept {
  const std::uint64_t age = link_.exchange(t, poses, feel, timeout);
  late_.limit(1e-9 * static_cast<double>(monotonic_ns()), poses, feel, age);
  return age;
}

void LateTools::limit(double now, std::span<const ToolPose> poses, std::span<ToolFeel> feel,
                      std::uint64_t age) noexcept {
  called_[calls_ % kKept] = now;
  const std::uint64_t oldest = std::min<std::uint64_t>(calls_, kKept - 1);
  for (std::size_t k = 0; k < safe_.tools(); ++k) {
    if (age > calls_)  // none yet
      safe_.miss(k, now, feel[k]);
    else
      safe_.limit(k, now, poses[k].point + poses[k].u, poses[k].turn, feel[k],
                  called_[(calls_ - std::min(age, oldest)) % kKept]);
  }
  ++calls_;
}

void LateTools::zero(std::span<ToolFeel> feel) noexcept {
  for (std::size_t k = 0; k < safe_.tools(); ++k) safe_.zero(k, feel[k]);
}

}  // namespace hapsim
