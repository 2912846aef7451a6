// What places that were left out of a fit tell of places that nobody has pressed.
#pragma once

#include "experiment/unseen_band.h"
#include "fit/fit.h"

namespace hapsim {

// One of the order statistics of the errors at places that were left out in turn, relative to the
// forces there (cross-conformal prediction: Vovk, Ann. Math. Artif. Intell. 74, 2015). Whatever the
// law of these errors, the next place like them exceeds it about as rarely as each of them would:
// that is sure for twice the chance of a miss, and usual for the chance itself (Barber, Candes,
// Ramdas and Tibshirani, Ann. Stat. 49, 2021). 95 % need 19 places; of n fewer ones it is the
// largest, with n/(n+1). At least the floor that mesh and shape leave. `body`: the forces that the
// body has by the model, stacked, without what the sensor does [N]. Unknown where not whole places
// were left out, and where a component was not measured.
UnseenBand held_out_band(const HeldOut& held_out, const Folds& folds, const Dataset& dataset,
                         const Allowance& allowance, const Eigen::VectorXd& body);
// Of a fitted model. Unknown where it solves for an offset of each press: that takes of a place's
// error what is the same all along a press.
UnseenBand held_out_band(const HeldOut& held_out, const Folds& folds, const Experiment& experiment,
                         const Allowance& allowance, const Fit& fitted);

}  // namespace hapsim
