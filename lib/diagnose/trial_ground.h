// What effects are tried on.
#pragma once

#include "experiment/experiment.h"

namespace hapsim {

// An experiment, and what a model is not blamed for there (the experiment's own allowance, or a
// larger one where its shape is in doubt). Both must outlive it.
struct TrialGround {
  const Experiment& experiment;
  const Dataset& dataset;  // the experiment's
  Allowance allowance;

  TrialGround(const Experiment& e, const Allowance& allowed)
      : experiment(e), dataset(e.dataset), allowance(allowed) {}
};

}  // namespace hapsim
