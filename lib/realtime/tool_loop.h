// A tool in contact, sample by sample, whatever model answers it.
#pragma once

#include <limits>

#include "effects/effect_step.h"
#include "experiment/fitted_range.h"
#include "mesh/tool_contact.h"
#include "mesh/way_through.h"

namespace hapsim {

struct ToolLoopOptions {
  ToolContactOptions contact;  // of step(): radius, release, sliding
  bool relaxed = true;         // the body is relaxed before each contact; false: it remembers
  FittedRange fitted;          // of the model; beyond it forces are said to be so
  bool sensor = true;  // forces as the model's sensor reads them; false: as a hand feels them
};

// What a force is said to be beyond: bits of ToolLoop::beyond().
enum Beyond : int {
  kBeyondDepth = 1,   // deeper than fitted, or than kValidShare of the way through the body
  kBeyondHeld = 2,    // it is that of kHeldShare of that way, where the tool is held to be
  kBeyondPlaces = 4,  // where contact meshes cannot be made: beside the support
  kBeyondFitted = 8,  // farther from the places that the model was fitted to than these lie apart
  kBeyondSpeed = 16,  // faster than it was fitted
  kBeyondLaw = 32     // farther into the surface or along it than the law was verified (LawRange)
};

// Finds the contact and hands displacements to a model. step(), begin() and press() allocate
// nothing, lock nothing, throw nothing and make no system call. Not to be shared between threads;
// one loop a tool.
class ToolLoop {
 public:
  // `surface` of the body, outlives the loop; null where only begin() and press() are used.
  ToolLoop(const SignedDistance* surface, const ToolLoopOptions& options);
  virtual ~ToolLoop() = default;

  // The tool at `tool` [m] at time t [s], anywhere: finds whether and where it touches. Force of
  // the body on the tool [N], away from it what the sensor reads of none. A sample that is not
  // finite, or beyond 10 m, repeats the last position; time that runs backwards counts as no time.
  Vec3 step(double t, const Vec3& tool) noexcept;

  // A recorded motion instead, whose contact point is known: begin() at each new press, then its
  // displacements u [m] from that point. `in_air`: no contact.
  void begin(const Vec3& contact) noexcept;
  Vec3 press(double t, const Vec3& u, bool in_air = false) noexcept;

  // Of the body from the next sample on [degC]; NaN, as at first: not known.
  void set_temperature(double temperature) noexcept { temperature_ = temperature; }

  const ToolState& tool() const { return contact_.state(); }
  // Of the last sample: Beyond, and the displacement that its force is of [m]. Without a surface
  // nothing is known of the way through it.
  int beyond() const { return beyond_; }
  const Vec3& pressed() const { return pressed_; }
  // Relative standard uncertainty of the last force that the place leaves; 0 where it is not known.
  double uncertainty() const { return uncertainty_; }

 protected:
  // Where the tool presses. Without a surface the normal is zero and the face -1.
  struct Place {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    int face = -1;
  };
  virtual void take_place(const Place& place) noexcept = 0;
  virtual void forget() noexcept = 0;  // relaxed from here on
  virtual Vec3 advance(double t, const Vec3& u) noexcept = 0;
  // Away from the body, displaced by u from where it touched last (zero: not known).
  virtual Vec3 advance_in_air(double t, const Vec3& u) noexcept;
  double temperature() const { return temperature_; }
  // What take_place() knows of the place.
  void set_quality(double uncertainty, bool sampled) noexcept {
    uncertainty_ = uncertainty, sampled_ = sampled;
  }
  // The sample at hand is beyond the law's range.
  void mark_beyond_law() noexcept { beyond_ |= kBeyondLaw; }
  // The range of the model's law [m]; at first it is endless.
  void set_law(const LawRange& law) noexcept { law_ = law; }

  void restore_tool(const ToolState& state) noexcept { contact_.restore(state); }

 private:
  void touch(const Place& place, const Vec3& told) noexcept;
  int beyond_at(double t, const Vec3& u, double share) noexcept;
  Vec3 press_within(double t, const Vec3& u) noexcept;
  Vec3 leave(double t, const Vec3& u) noexcept;

  const SignedDistance* surface_;
  ToolLoopOptions options_;
  ToolContact contact_;
  WayThrough way_;
  Vec3 pressed_ = Vec3::Zero();
  int beyond_ = 0;
  double uncertainty_ = 0;
  bool sampled_ = true, fitted_ = true;  // of the place
  LawRange law_{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  ToolSpeed speed_;
  double temperature_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace hapsim
