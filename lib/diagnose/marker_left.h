// What a fitted model leaves of the displacements of marked points.
#pragma once

#include <string>

#include "diagnose/trial_ground.h"
#include "fit/fit.h"

namespace hapsim {

// Effects are tried and ranked by their forces alone; points then judge what was found, as torques
// do (TorqueLeft): what a model that is fitted to both leaves of the points beyond noise and
// meshes, or of the forces so as to have the points, is not explained.
struct MarkerLeft {
  MarkerError error;       // no rows: there are no points, or the model does not say where they go
  double force_error = 0;  // of that fit, over the error of the forces fitted alone
  bool off = false;        // more is left than noise
  std::string words;       // what is left, or why points say nothing of this model; "": nothing

  bool explained() const { return !off; }
};

// `fitted`: to the forces alone. `markers`: of the ground's experiment; null: none.
MarkerLeft marker_left(const Fit& fitted, const TrialGround& ground, const Markers* markers);

}  // namespace hapsim
