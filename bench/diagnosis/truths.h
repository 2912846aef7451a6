// What is hidden in the trials of the diagnosis, and how large.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/random.h"
#include "experiment/experiment.h"

namespace hapsim::bench {

enum class NoiseKind { kWhite, kCorrelated, kOutliers };

// One way in which the measured forces differ from the model that is diagnosed.
struct Truth {
  std::string name;                  // of the trial: an effect, or an effect and the form it takes
  std::vector<std::string> effects;  // what the diagnosis should name; none for nothing
  double most = 1;                   // of `strength`
  std::vector<std::string> base;  // effects that the diagnosed model has already, and the truth too
  bool open = false;              // the recording does not say when the tool is in the air
  int presses = 0;                // all but the first so many are left out; 0: none
  NoiseKind noise = NoiseKind::kWhite;
  double noisier = 1;  // the sensor's noise, over the usual
  int sizes = 0;       // > 0: `strength` is 1 .. sizes, each a size of its own (finite elements)
  std::vector<std::string> parts;  // two truths or more with models, each as strong as asked
  std::vector<double> levels;      // of each part, over the noise; empty: drawn
  // The base with the effect, where it has the catalogue's own form; else empty.
  std::function<Model(const Model& base, double strength)> model;
  // Stacked forces at a strength from 0 (nothing) on; the same seed draws the same effect.
  std::function<Eigen::VectorXd(const Experiment&, const Model& base, double strength, Random&)>
      forces;
};

std::vector<Truth> all_truths();
const Truth& find_truth(const std::vector<Truth>& truths, const std::string& name);

// The model of the body behind all trials, with the effects of `base` at their true values.
Model true_base(const std::vector<std::string>& base);
// Stacked forces of a model, features solved by finite elements.
Eigen::VectorXd forces_of(const Experiment& w, const Model& model);

// What the base, less a common gain, leaves of the truth's forces [N] rms.
double misfit_of(const Eigen::VectorXd& forces, const Truth& truth, const Experiment& w);
// The largest of that.
double largest_misfit(const Truth& truth, const Experiment& w, std::uint64_t seed);
// The strength at which that is `misfit`; negative when even the largest does not reach it.
double strength_for(const Truth& truth, const Experiment& w, double misfit, std::uint64_t seed);

}  // namespace hapsim::bench
