// Whether what an effect does has one size in the whole recording.
#pragma once

#include <string>

#include "diagnose/candidate.h"

namespace hapsim {

// How an effect's size differs between parts of the recording, beyond chance.
struct SizeSpread {
  double share = 0;   // root mean square over the parts, of the size itself
  std::string among;  // what parts it differs most among: "presses", "depths", ...
};

// An effect that acts has one size: its name claims how the force depends on depth, time, direction
// and place. Where it stands for another cause it follows that one in some parts and misses it in
// others. With d what the effect changes of the whitened forces and r what the model leaves, each
// part b gets a size of its own, r ~ sum_b c_b d 1_b, beside all that the model's own parameters
// follow: the squares that this takes off, less what chance takes (as many mean squares of r, of so
// many samples as err alike, as there are parts), over those of all the d 1_b beside the other
// effects' parameters. That is the score test of varying coefficients (Breusch and Pagan,
// Econometrica 47, 1979), told as a size. Parts are presses, depths, times since the press began
// and axes. `effect` is in the model.
SizeSpread size_spread(const std::string& effect, const Fit& fitted, const TrialGround& ground);

// What was found is possible only, for that reason.
void doubt(const std::string& why, Finding& finding);

// The last finding that is missing and takes less away, with all of its terms, than `base`, the
// model with all of them, leaves beyond noise (squares); null: none. It may stand for anything, as
// a name or as a curve of no law; of maps and fields nothing is said.
const Finding* outweighed(const Baseline& base, const TrialGround& ground,
                          const std::vector<Finding>& findings);

// Where `base`, the model with all that is missing, or with the best of the rivals, leaves more
// than noise: the last that takes less away than is left (outweighed()), else the last name whose
// size differs by more than kOneSize, becomes possible, and `base` is without it; rivals do where
// the sizes of all of them differ so, for a set with the truth in it is true. Curves of no law and
// maps claim no size. d.rivals, d.findings and `base` as the search leaves them. Whether any did.
bool doubt_one(Baseline& base, const TrialGround& ground, const Folds& folds, Diagnosis& d);

}  // namespace hapsim
