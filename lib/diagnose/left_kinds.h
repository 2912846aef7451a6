// What that which a model leaves goes with, judged by presses that were left out.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnose/trial_ground.h"

namespace hapsim {

// How much of what is left beyond noise a kind of law foretells.
struct LeftKind {
  std::string kind;   // of LeftOver::kind
  double share = 0;   // of the squares beyond noise, on presses that it was not fitted to
  bool alike = true;  // presses do not tell it from the one that foretells most
};

// Of what `residual` [N] holds beyond noise: the kinds of law that foretell it, the largest share
// first; before them those that presses do not tell from the best of all (they foretell half as
// much at least, and what they err by more, a press on average, is less than twice its own error),
// of four fifths as much the one with the fewest numbers first. Each is linear in its numbers
// (diagnose/kind_laws.h), has a gain of all forces along the normal and one across it beside it,
// and counts where it foretells a tenth more than these alone (the set-up's: than nothing); of two
// variables where at most half of it is foretold without its kind's (KindLaw::without):
//   offset, drift   a zero of each axis and along the normal; one by the session's time (hat
//                   functions)
//   depth, contact-time, phase, temperature
//                   gains, or zeros, that differ by depth (also by how far each axis moved), time
//                   since the press began, loading, hold and unloading by depth or the deepest so
//                   far, temperature
//   cycle           by what was pressed before (diagnose/order_laws.h), alone, by depth, by the
//                   time since the press began and by how far the force leans
//   session-time    gains, along the normal and across it or of each axis, by the session's time,
//                   the same way
//   rate            by speed (also the largest so far) the force and its rate; the velocity
//   history         what the increments of force did so and so long before (a kernel of finite
//                   length, lags in steps of a third)
//   reading         an error of each axis by its own force, in forty steps: a converter's
//   set-up          any 3 x 3 matrix of the force, or of the motion
//   direction       these two gains alone (than nothing); gains that differ by how far the force
//                   leans, across the normal by which way; the law of shared_law.h
//   body            six gains of each position (experiment/weights.h); any 3 x 3 matrix, or gains
//                   along the normal and across it with a turn about it, that change evenly from
//                   one side of all places to the other; gains by depth that change so, or curve
//   press, place-and-way, zero-of-press, wander
//                   what each press has of its own (diagnose/own_laws.h), where no law of unseen
//                   presses foretells half
// `forces`: of the model. Empty for fewer presses than kLeastPresses.
std::vector<LeftKind> kinds_of(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                               const TrialGround& ground);

// "the depth", "a zero of each press (...)": what a kind goes with, in words.
const char* goes_with(const std::string& kind);
// "Tried on presses that were left out, the speed foretells 74 % of that, ..."; "" of none.
std::string words_of(const std::vector<LeftKind>& kinds);

}  // namespace hapsim
