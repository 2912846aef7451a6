// The last layer before hands that hold tools which press and turn.
#pragma once

#include <array>
#include <optional>

#include "realtime/several_tools.h"
#include "safety/safe_force.h"

namespace hapsim {

// A SafeForce for each tool's force, and one for its torque at SafetyLimits::lever. Nothing
// allocates, throws, locks or asks the system.
class SafeTools {
 public:
  SafeTools(const SafetyLimits& limits, std::size_t tools, double period = 1e-3);

  std::size_t tools() const { return tools_; }
  // What tool `k` may feel of `feel`, in place, with its tip at `tip` [m] and turned by `turn`
  // [rad], at time `now` [s] of a clock that nobody sets, out of what was true at `fresh`.
  void limit(std::size_t k, double now, const Vec3& tip, const Vec3& turn, ToolFeel& feel,
             double fresh) noexcept;
  // Nothing new has come for it.
  void miss(std::size_t k, double now, ToolFeel& feel) noexcept;
  // At once, and for ever: the end.
  void zero(std::size_t k, ToolFeel& feel) noexcept;

  // Whether any of them is without valid samples now for longer than `hold`.
  bool lost() const;
  const SafetyLimits& limits() const { return limits_; }

 private:
  struct Tool {
    Tool(const SafetyLimits& limits, double period)
        : force(limits, period), torque(of_torque(limits), period) {}
    SafeForce force, torque;
    int press = 0;
  };
  void set(const SafeSample& force, const SafeSample& torque, ToolFeel& feel) const noexcept;

  SafetyLimits limits_;
  std::size_t tools_;
  std::array<std::optional<Tool>, kMostTools> tool_;
};

}  // namespace hapsim
