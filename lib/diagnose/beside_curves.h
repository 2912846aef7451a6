// Names of laws against curves over the same thing.
#pragma once

#include "diagnose/candidate.h"
#include "diagnose/diagnose.h"

namespace hapsim {

// A curve without a law that is needed beside the law of a named effect over the same thing (depth,
// time, session: its card's confounders) says that the law has not the cause's form. The name is
// then possible only, and `base` is without it. Fields of places do not count, for shape and mesh
// ask for them too; nor where rivals are left. d.findings and `base` as the search leaves them.
void doubt_beside_curves(Baseline& base, const TrialGround& ground, const Folds& folds,
                         Diagnosis& d);

// Where all that is missing leaves more than noise, a law is believed only if no curve over the
// same thing does better on what is unseen (curve_in_place()): that one is missing then, the name
// possible, and `base` with the curve instead. The last that was found comes first.
void curves_for_laws(Baseline& base, const TrialGround& ground, const Folds& folds,
                     const DiagnoseOptions& options, Diagnosis& d);

}  // namespace hapsim
