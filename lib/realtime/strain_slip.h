// What friction under a flat tool takes from the force of one that holds, at finite strain.
#pragma once

#include <vector>

#include "realtime/rim_slip.h"
#include "realtime/slip_presses.h"

namespace hapsim {

struct StrainSlip {
  RimSlip rim;
  double deepest = 0;  // tool radii: so deep places were pressed
  double seen = 1;     // of mu N, how much the tool was seen to bear sideways: beyond, extrapolated
  double doubt = 0;    // standard relative uncertainty of its forces, beside those of a held tool
};

struct SlipPlace {
  StrainSample sample;
  SlipPresses presses;
};

// The rings whose forces over those of a tool that holds, by each place's own sample, are those of
// the presses there: least squares of all motions of all places, relative to each force with a
// floor of 5 % of a motion's largest. What is left of them, and the elements' own, is the doubt.
// Takes a second or two. At least one place; threads as LargeStrainOptions has them.
StrainSlip fit_strain_slip(const std::vector<SlipPlace>& places, int threads);

}  // namespace hapsim
