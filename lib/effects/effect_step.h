// An effect as a loop takes it: sample by sample, with all that it remembers in plain numbers.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "effects/effect.h"

namespace hapsim {

// What is known before the first sample.
struct StepContext {
  double tool_radius = 0;  // [m]
  double modulus = 0;      // E of region 0 [Pa]
  bool heals = false;      // the body recovers between presses (metadata `recovery: full`)
};

// Where a press stands.
struct StepPlace {
  Vec3 point = Vec3::Zero();    // on the undeformed surface [m]
  Vec3 normal = Vec3::UnitZ();  // outward
  ContactStiffness contact;     // without derivatives
};

// One sample of a press, as PressView has it.
struct StepSample {
  bool first = true;   // of its press
  int number = 1;      // of the press, from 1
  double t = 0;        // [s] since the press began
  double dt = 0;       // [s] since its last sample; 0: the first
  double session = 0;  // [s] since the first sample of all
  bool in_air = false;
  double temperature = std::numeric_limits<double>::quiet_NaN();  // [degC]; NaN: not known
  Vec3 recorded = Vec3::Zero();                                   // displacement as it came [m]
  Vec3 u = Vec3::Zero();         // and as the motion effects have left it
  double moduli = 1, times = 1;  // factors of all Maxwell elements' moduli and relaxation times
};

// How far into the surface and along it a law's forces were verified; 0: it says nothing of that.
struct LawRange {
  double into = 0, along = 0;
};

// Made before the loop, where it may take memory; from then on nothing allocates, locks, throws or
// calls the system. What it remembers lies in the loop's memory, which is stored and gone on from
// as it is: so many numbers, all 0 at the start of the session, handed to every call.
class EffectStep {
 public:
  virtual ~EffectStep() = default;
  virtual std::size_t memory() const { return 0; }
  // The tool presses there from the next sample on; also when a stored state is gone on from. What
  // is derived from the place is not memory.
  virtual void take_place(const StepPlace& /*place*/) noexcept {}
  // Of a law that takes the linear one's place: its own range, in tool radii.
  virtual LawRange law() const { return {}; }
  // Of the last sample: how many times as large as in the stiffness of its place, relatively, an
  // error is in its force.
  virtual double share_of_stiffness() const noexcept { return 1; }
  // How far over the surface it still acts on a tool that has touched [m].
  virtual double reach() const { return 0; }
  // Motion effects (Effect::move): changes sample.u.
  virtual void move(StepSample& /*sample*/, double* /*memory*/) noexcept {}
  // Other effects (Effect::apply): changes the force [N].
  virtual void apply(const StepSample& /*sample*/, double* /*memory*/, Vec3& /*f*/) noexcept {}
};

// The step of an effect that remembers nothing and asks for no place: map(sample, f) changes f.
template <class Map>
std::unique_ptr<EffectStep> map_step(Map map) {
  class Step : public EffectStep {
   public:
    explicit Step(Map map) : map_(std::move(map)) {}
    void apply(const StepSample& sample, double*, Vec3& f) noexcept override { map_(sample, f); }

   private:
    Map map_;
  };
  return std::make_unique<Step>(std::move(map));
}

}  // namespace hapsim
