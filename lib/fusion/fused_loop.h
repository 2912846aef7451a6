// A fast loop put right by a solver that runs at its own pace in a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "acfm/acfm_loop.h"
#include "fusion/fusion.h"
#include "realtime/latency.h"
#include "realtime/spsc_ring.h"

namespace hapsim {

// A contact as the slow solver has it; made and used in its thread, may throw Error.
class SlowPress {
 public:
  virtual ~SlowPress() = default;
  virtual Vec3 step(const Vec3& u, double dt) = 0;  // as FullPress
};
using SlowMaker = std::function<std::unique_ptr<SlowPress>(const Vec3& contact)>;

// The solver takes the newest sample whenever it is ready and gives its force back when it has it:
// the loop puts that in at its own time. step() and press() neither lock nor allocate; the two
// threads meet in two queues. A solver that fails stops; the loop goes on with the fast source and
// failure() says why.
class FusedLoop : public ToolLoop {
 public:
  // `fast` is used by this loop alone and outlives it, as `surface` does. `coarse`: another of the
  // same model, for the thread alone, or null. It takes the solver's steps, so that what a body
  // that relaxes makes of a way drawn straight from one step to the next is known, and taken off.
  FusedLoop(ToolLoop& fast, SlowMaker slow, const FusionParameters& parameters,
            const SignedDistance* surface = nullptr, const ToolLoopOptions& options = {},
            ToolLoop* coarse = nullptr);
  ~FusedLoop() override;

  const FusionReport& report() const { return fusion_.report(); }
  // Ends the thread; then the times of the slow steps, and why it failed, if it did.
  void stop();
  const LatencyHistogram& slow_steps() const { return slow_steps_; }
  const std::string& failure() const { return failure_; }

 protected:
  void take_place(const Place& place) noexcept override;
  void forget() noexcept override {}
  Vec3 advance(double t, const Vec3& u) noexcept override;

 private:
  struct Sample {
    long contact = 0;
    double t = 0;
    Vec3 point = Vec3::Zero(), u = Vec3::Zero();  // displacement, or force [N] on the way back
    Vec3 fast = Vec3::Zero();                     // force of the fast source [N]
  };
  void work();

  ToolLoop& fast_;
  ToolLoop* coarse_;
  SlowMaker make_;
  Fusion fusion_;
  SpscRing<Sample> there_, back_;
  long contact_ = 0;
  Vec3 point_ = Vec3::Zero();
  bool begins_ = false;
  LatencyHistogram slow_steps_;  // of the thread until it has ended
  std::string failure_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace hapsim
