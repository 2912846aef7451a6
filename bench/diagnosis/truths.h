// What is hidden in the trials of the diagnosis, and how large.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/random.h"
#include "model/workspace.h"

namespace hapsim::bench {

// One way in which the measured forces differ from the model that is diagnosed.
struct Truth {
  std::string name;               // of the trial: an effect, or an effect and the form it takes
  std::string effect;             // what the diagnosis should name; "" for nothing
  bool open = false;              // the recording does not say when the tool is in the air
  double most = 1;                // of `strength`
  std::vector<std::string> base;  // effects that the diagnosed model has already, and the truth too
  // Stacked forces at a strength from 0 (nothing) on; the same seed draws the same effect.
  std::function<Eigen::VectorXd(const Workspace&, const Model& base, double strength, Random&)>
      forces;
};

std::vector<Truth> all_truths();

// The model of the body behind all trials, with the effects of `base` at their true values.
Model true_base(const std::vector<std::string>& base);

// The strength at which the truth differs from its base, less a common gain, by `misfit` [N] rms;
// negative when even the largest does not reach it.
double strength_for(const Truth& truth, const Workspace& w, double misfit, std::uint64_t seed);

}  // namespace hapsim::bench
