// Whether residuals ask for another contact stiffness, over all positions, and where most.
#pragma once

#include "diagnose/trial_ground.h"
#include "fit/fit.h"

namespace hapsim {

// The part of the whitened residuals that any change of the positions' stiffnesses (six numbers
// each) takes away: a chi-square when noise and mesh are all there is. Layers, inclusions, regions,
// anisotropy and supports can do no more.
struct Departures {
  double total = 0, freedom = 0;
  double largest = 0;         // of one position, of six degrees
  Vec3 where = Vec3::Zero();  // that position [m]
  bool anywhere() const;      // beyond three standard deviations
};
Departures stiffness_departures(const Fit& fitted, const TrialGround& ground);

}  // namespace hapsim
