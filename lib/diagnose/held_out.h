// The error of a fitted model on positions that it has not seen.
#pragma once

#include "diagnose/trial_ground.h"
#include "fit/extend.h"

namespace hapsim {

// How a diagnosis fits and extends what it tries.
FitOptions trial_fit_options(const TrialGround& g, int rounds = 6);
ExtendOptions trial_extend_options(const TrialGround& g);

// Where the stiffness changes over the body: what effects made from the positions say.
bool has_map(const Model& model);

// What becomes of a model's map where positions are left out. Anew: made from the others alone, as
// for a place that was never pressed. Known: kept, with its moduli refitted. A boundary is only
// known to lie between the pressed positions, and errs so much on those left out that no other
// effect would show there; whether one holds on unseen positions is asked with the map known. A map
// that gives positions moduli of their own, or would have a region without any, is made anew all
// the same.
enum class Map { kAnew, kKnown };

// By true refits.
HeldOut held_out_of(const Fit& fitted, const TrialGround& ground, const Folds& folds, Map map);

// The same made and fitted by all positions as it is by those of a fold: of first order where that
// makes a map anew, which the fit itself has solved.
Fit fitted_as_in_folds(const Fit& fitted, const TrialGround& ground, Map map);

}  // namespace hapsim
