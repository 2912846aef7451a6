#include "fusion/fused_loop.h"

#include <chrono>

#include "base/error.h"
#include "realtime/real_time.h"

namespace hapsim {
namespace {

constexpr std::size_t kQueue = 4096;
constexpr std::chrono::microseconds kIdle{200};

}  // namespace

FusedLoop::FusedLoop(ToolLoop& fast, SlowMaker slow, const FusionParameters& parameters,
                     const SignedDistance* surface, const ToolLoopOptions& options,
                     ToolLoop* coarse)
    : ToolLoop(surface, options),
      fast_(fast),
      coarse_(coarse),
      make_(std::move(slow)),
      fusion_(parameters),
      there_(kQueue),
      back_(kQueue),
      thread_([this] { work(); }) {}

FusedLoop::~FusedLoop() {
  stop();
}

void FusedLoop::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void FusedLoop::take_place(const Place& place) noexcept {
  fast_.begin(place.point);
  point_ = place.point;
  ++contact_;
  begins_ = true;
}

Vec3 FusedLoop::advance(double t, const Vec3& u) noexcept {
  if (begins_) fusion_.begin(t, point_);
  begins_ = false;
  const Vec3 fast = fast_.press(t, u);
  const Vec3 fused = fusion_.step(t, u, fast);
  there_.push({contact_, t, point_, u, fast});
  for (Sample slow; back_.pop(slow);)
    if (slow.contact == contact_) fusion_.observe(slow.t, slow.u);
  return fused;
}

void FusedLoop::work() {
  try {
    std::unique_ptr<SlowPress> press;
    Sample newest, first, sample;
    long contact = 0;
    double last = 0;
    Vec3 force = Vec3::Zero();
    while (!stop_) {
      bool any = false;
      while (there_.pop(sample)) {
        if (sample.contact != newest.contact) first = sample;
        newest = sample;
        any = true;
      }
      if (!any) {
        std::this_thread::sleep_for(kIdle);
        continue;
      }
      const std::int64_t start = monotonic_ns();
      if (newest.contact != contact) {
        press = make_(newest.point);
        contact = newest.contact;
        // From where the contact began: coming in half-way, a body that relaxes would take the way
        // so far for a jump.
        force = press->step(first.u, 0);
        last = first.t;
        if (coarse_ != nullptr) {
          coarse_->begin(newest.point);
          coarse_->press(first.t, first.u);
        }
      }
      if (newest.t > last) force = press->step(newest.u, newest.t - last);
      last = newest.t;
      // The straight way's share of the force, as the fast model has it.
      Vec3 given = force;
      if (coarse_ != nullptr) given += newest.fast - coarse_->press(newest.t, newest.u);
      slow_steps_.add(monotonic_ns() - start);
      back_.push({contact, newest.t, newest.point, given, {}});
    }
  } catch (const Error& error) {
    failure_ = error.what();
  }
}

}  // namespace hapsim
