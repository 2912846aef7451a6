// What a fitted model leaves of the tool's measured torques.
#pragma once

#include <string>

#include "diagnose/trial_ground.h"
#include "fit/fit.h"

namespace hapsim {

// Effects are tried and ranked by their forces alone; torques then judge what was found. The model
// is fitted to both: what it leaves of the torques beyond noise and levers
// (TorqueWeights), or of the forces so as to have the torques, is not explained.
struct TorqueLeft {
  TorqueError error;       // no rows: none were measured, or the model does not say what they are
  TorquePole pole;         // about which what is left would be least
  double force_error = 0;  // of that fit, over the error of the forces fitted alone
  bool off = false;        // more is left than noise
  // What is left, and that it is as if the tool touched at another point; or why torques say
  // nothing of this model. "": nothing is to be told.
  std::string words;

  bool explained() const { return !off; }
};

// `fitted`: to the forces alone.
TorqueLeft torque_left(const Fit& fitted, const TrialGround& ground);

}  // namespace hapsim
