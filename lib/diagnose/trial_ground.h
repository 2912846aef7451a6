// What effects are tried on.
#pragma once

#include <cmath>

#include "experiment/experiment.h"
#include "experiment/forces.h"

namespace hapsim {

// An experiment, and what a model is not blamed for there (the experiment's own allowance, or a
// larger one where its shape is in doubt). Both must outlive it.
struct TrialGround {
  const Experiment& experiment;
  const Dataset& dataset;  // the experiment's
  Allowance allowance;

  TrialGround(const Experiment& e, const Allowance& allowed)
      : experiment(e), dataset(e.dataset), allowance(allowed) {}

  // Root mean square that noise, mesh and shape may leave of the forces [N].
  double allowed_error() const {
    const Eigen::VectorXd f = measured_forces(dataset, all_episodes(dataset));
    return std::hypot(allowance.noise,
                      allowance.floor * f.norm() / std::sqrt(static_cast<double>(f.size())));
  }
};

}  // namespace hapsim
