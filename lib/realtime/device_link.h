// Between a device's own thread and the loop that knows the body: positions there, forces back,
// without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <thread>

#include "realtime/several_tools.h"
#include "realtime/spsc_ring.h"

namespace hapsim {

// The tools are moved by a thread of this class's own, which answers the newest poses and passes
// over older ones. The device's thread never waits longer than it says.
class DeviceLink {
 public:
  // `tools` outlives it, and is nobody else's meanwhile.
  explicit DeviceLink(SeveralTools& tools);
  ~DeviceLink();
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;

  // By one thread: hands over the poses of the tools' tips at time t [s] (SeveralTools::step()) and
  // waits for what they feel, at most `timeout` [ns], with the processor. Returns how old the
  // answer is that `feel` now holds, in calls: 0: of these very poses; n: of those n calls ago, for
  // the loop is late; kNever: there was none yet, and `feel` is of tools in the air. The caller
  // decides what a late force is worth. Allocates nothing, locks nothing, throws nothing; reads the
  // clock, and makes no other system call.
  std::uint64_t exchange(double t, std::span<const ToolPose> poses, std::span<ToolFeel> feel,
                         std::int64_t timeout) noexcept;
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

 private:
  struct Asked {
    std::uint64_t number = 0;
    double t = 0;
    std::array<ToolPose, kMostTools> pose;
  };
  struct Answered {
    std::uint64_t number = 0;
    std::array<ToolFeel, kMostTools> feel;
  };
  void answer() noexcept;

  SeveralTools& tools_;
  SpscRing<Asked> asked_;
  SpscRing<Answered> answered_;
  Asked asking_;     // of exchange()
  Answered newest_;  // of exchange()
  std::atomic<bool> ends_{false};
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace hapsim
