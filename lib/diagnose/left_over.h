// What a fitted model leaves: noise, or something, and of which kind.
#pragma once

#include <string>

#include "diagnose/left_kinds.h"
#include "diagnose/locked_events.h"
#include "diagnose/trial_ground.h"
#include "fit/fit.h"

namespace hapsim {

// Kinds of LeftOver.
inline constexpr const char *kSetUp = "set-up", *kBody = "body", *kFrequency = "frequency",
                            *kEvent = "event", *kDirection = "direction", *kPress = "press",
                            *kZeroOfPress = "zero-of-press", *kPlaceAndWay = "place-and-way",
                            *kWander = "wander";

// The allowance for mesh and shape error is a prior of the six gains c_p of each position
// (experiment/weights.h), of standard deviation delta. What the forces say of them is tested: with
// the model's residual r and the gains' directions Z,
//   c_p = (Z'Z / sigma^2 + I / delta^2)^-1 Z'r / sigma^2,
// whose squares over delta^2 add up to a chi-square of six degrees a position, or less, if mesh and
// shape are all there is. Beyond it the allowance holds what is none of theirs. Gains that all
// positions share tell what: those that are the same everywhere, in the recording's axes or along
// each place's normal, come from what all places share (sensor, robot, tool); those that differ by
// place come from the body.
struct LeftOver {
  double error = 0;         // over the noise, measured components pooled
  double beside_gains = 0;  // the same with the gains c_p taken off
  double strain = 0;        // sum |c_p|^2 / delta^2 over six a position: 1 is what was allowed
  double common = 0;  // largest gain that all share, over its deviation delta / sqrt(positions)
  double common_share = 0;    // of the strain that goes with the gains that all share
  Vec3 where = Vec3::Zero();  // the position of the largest |c_p| [m]
  bool strained = false;    // by all positions, by their mean or by one, beyond chance (kStrained)
  bool structured = false;  // beside the allowance: more than noise, and samples foretell samples
  LockedEvents events;      // looked for where neither is the case
  // "": noise alone; "set-up", "body", "place" (one) where the allowance is strained, "event" of
  // single samples at one part of the presses (of whole presses: Diagnosis::odd_presses),
  // "frequency" of a line that stands out of the session or a part of it where hs-compare tells
  // nothing, else what it tells: "depth", "contact-time", "offset", ...; of tell_kinds(): theirs
  std::string kind;
  std::vector<LeftKind> kinds;  // by tell_kinds()
  std::string observed;         // what hs-compare sees in it, and the line: sentences

  bool noise_alone() const { return !strained && !structured && !events.found; }
  // How much is left, of which kind, and where to look: sentences; "" of noise alone.
  std::string words;
};

LeftOver left_over(const Fit& fitted, const TrialGround& ground);

// Adds what presses that were left out say (kinds_of()), with words. The kind becomes the first of
// them, unless it is an event, a line or one place; where they say nothing of what no gains of
// places or of all account for, "frequency" of a swing that is no line, or "left"; where they say
// less than half, "frequency" of a line that each press has of its own (find_press_lines()).
void tell_kinds(const Fit& fitted, const TrialGround& ground, LeftOver& left);

}  // namespace hapsim
