// A few presses that are unlike all others, whatever was pressed there.
#pragma once

#include <string>
#include <vector>

#include "diagnose/trial_ground.h"
#include "fit/fit.h"

namespace hapsim {

// The presses that err most are set aside, one after the other, each time with the model fitted
// anew (a forward search, Atkinson and Riani, 2000, run backwards), until what the others leave is
// noise alone; those which then err no more than kOdd times noise and allowance come back. At most
// every fourth press is odd. An odd press says nothing of the body or the law where the place and
// the motion both speak against it: at its place another press is as the model says, and others of
// like depth and slant are, some no slower and some no faster, and they are not those that went
// furthest, in some direction, or fastest. Else none is found: the place or the motion is the
// story.
struct OddPresses {
  static constexpr double kOdd = 2;
  std::vector<int> ids;  // as the recording numbers them, in its order; empty: none
  double beside = 0;     // error that the others leave, fitted alone, over the noise
  double off = 0;        // largest error of one of them beside the others' model, over the noise
  std::string words() const;  // a sentence
};

OddPresses find_odd_presses(const Fit& fitted, const TrialGround& ground);

}  // namespace hapsim
