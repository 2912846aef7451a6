// A device's own thread and the loop that knows the body, with the last layer before the hand.
#pragma once

#include "realtime/device_link.h"
#include "safety/safe_tools.h"

namespace hapsim {

// SafeTools for answers that may be of poses of some calls ago: they count by when those were
// handed over. Of one thread. Allocates, locks and throws nothing.
class LateTools {
 public:
  LateTools(const SafetyLimits& limits, std::size_t tools, double period = 1e-3)
      : safe_(limits, tools, period) {}
  // What the hands may feel at `now` [s] of `feel`, which is of the poses of `age` calls ago
  // (DeviceLink::exchange()).
  void limit(double now, std::span<const ToolPose> poses, std::span<ToolFeel> feel,
             std::uint64_t age) noexcept;
  // At once, and for ever: the end.
  void zero(std::span<ToolFeel> feel) noexcept;
  // Whether the answers are older than `hold`.
  bool lost() const { return safe_.lost(); }

 private:
  static constexpr std::size_t kKept = 4096;  // calls; what is older is older than any hold
  SafeTools safe_;
  std::array<double, kKept> called_{};  // when [s]
  std::uint64_t calls_ = 0;
};

// DeviceLink whose forces are safe whatever its loop does: one that hangs is a force that is held,
// then goes to zero by the device's own clock.
class SafeDevice {
 public:
  // `link` outlives it, and has so many tools. `period`: of the device's loop [s].
  SafeDevice(DeviceLink& link, const SafetyLimits& limits, std::size_t tools, double period = 1e-3)
      : link_(link), late_(limits, tools, period) {}

  // As DeviceLink::exchange(), whose age it returns; `feel` is what the hands may feel now.
  std::uint64_t exchange(double t, std::span<const ToolPose> poses, std::span<ToolFeel> feel,
                         std::int64_t timeout) noexcept;
  void zero(std::span<ToolFeel> feel) noexcept { late_.zero(feel); }
  bool lost() const { return late_.lost(); }

 private:
  DeviceLink& link_;
  LateTools late_;
};

}  // namespace hapsim
