// Whether residuals ask for another contact stiffness, over all positions and at the worst one.
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
  double typical = 0;         // median over the positions
  Vec3 where = Vec3::Zero();  // that position [m]
  bool anywhere() const;      // beyond three standard deviations
  // One position beyond what chance does to one in ten million, and unlike the others.
  bool at_one() const;
};
Departures stiffness_departures(const Fit& fitted, const TrialGround& ground);

}  // namespace hapsim
