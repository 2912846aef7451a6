// What a model lacks, found effect by effect among many presses.
#pragma once

#include <vector>

#include "diagnose/candidate.h"

namespace hapsim {

// What is settled first, as it was found; then the largest gain.
void put_in_order(std::vector<Finding>& findings);

// Adds the best effect while one passes the gates; fills in the findings of `d`, its rivals and,
// where there are any, what the best of them leaves. A name is believed first; where all names
// together leave more than noise, or one of them is an offset of each press, which imitates
// anything, a curve of no law is tried in their place, and stands where it foretells plainly
// better: the cause is then of its kind, and of none of their forms. In the place of three names
// and more it is tried too, and stands with what fewer are needed beside it where noise alone is
// left and it foretells as well. `base` becomes the model with all that is missing.
void search(Baseline& base, const TrialGround& ground, const Folds& folds,
            const DiagnoseOptions& options, Diagnosis& d);

// Where a name that was found is not stood by and more than noise is left without it, the curves of
// no law that pass the gates are found in its place.
void curves_for_doubted(Baseline& base, const TrialGround& ground, const Folds& folds,
                        const DiagnoseOptions& options, Diagnosis& d);

}  // namespace hapsim
