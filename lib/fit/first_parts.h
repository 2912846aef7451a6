// Learning from the first part of each press, and what that foretells of the rest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fit/fit.h"

namespace hapsim {

// Rows of an experiment that a fit may see, and later ones that it has to foretell.
struct FirstParts {
  Experiment known;          // the presses' first rows
  std::vector<char> unseen;  // by stacked row of the whole
  std::vector<int> stretch;  // by stacked row: neighbours that may err together, -1 elsewhere
  int stretches = 0;
};

// Two divisions of every press: two thirds of the way in foretell its last third, and the way in
// with the first two fifths of the hold the rest of the hold. The way out belongs to neither, but
// stands for the hold where nothing is held. A division without ten rows to foretell is left out.
std::vector<FirstParts> first_parts(const Experiment& experiment);

// The squared error on what was unseen, by stretch, each model truly refitted to what is known.
// Bodies stay linear about what the fit on all rows stands on.
struct Foretold {
  std::vector<double> squares;     // by stretch [N^2]
  std::vector<double> components;  // by stretch
  ForceError error(int axes) const;
};
Foretold foretell(const Fit& fitted, const Experiment& experiment,
                  const std::vector<FirstParts>& parts, const FitOptions& options);

// Share of resampled sets of stretches (bootstrap; Kuensch, Annals of Statistics 17, 1989) in which
// `after` does not err less than `before`. 1: nothing was unseen.
double chance_of_no_fall(const Foretold& before, const Foretold& after, int resamples,
                         std::uint64_t seed);

// Why an effect of the fitted model counts for nothing: all its parameters are at their identity or
// err by as much as they differ from it. "": it counts.
std::string counts_for_nothing(const Model& model, const std::string& effect);

}  // namespace hapsim
