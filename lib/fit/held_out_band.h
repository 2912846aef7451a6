// What places that were left out of a fit tell of places that nobody has pressed.
#pragma once

#include "experiment/unseen_band.h"
#include "fit/fit.h"

namespace hapsim {

// One of the order statistics of the errors at places that were left out in turn, relative to the
// forces there: the next place like them exceeds it as rarely as each of them would, whatever the
// law of these errors (cross-conformal prediction: Vovk, Ann. Math. Artif. Intell. 74, 2015;
// Barber, Candes, Ramdas and Tibshirani, Ann. Stat. 49, 2021). 95 % need 19 places; of n fewer ones
// it is the largest, and holds with n/(n+1). At least the floor that mesh and shape leave. Unknown
// where not whole places were left out.
UnseenBand held_out_band(const HeldOut& held_out, const Folds& folds, const Dataset& dataset,
                         const Allowance& allowance);

}  // namespace hapsim
