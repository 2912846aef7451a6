// hs-identify --refine-boundary: the boundaries between regions move with their moduli.
#pragma once

#include "cli/tool.h"
#include "experiment/experiment.h"
#include "fit/boundary_fit.h"
#include "fit/fit_words.h"
#include "hs-identify/flags.h"

namespace hapsim {

inline Option boundary_flag() {
  return {
      .flag = flag::boundary,
      .value = "N",
      .help =
          "Refines the boundaries between the regions in turn with their moduli: N key "
          "points along each move across it, as the forces along and across the surface "
          "ask. Between two regions (or more that explain the positions no better than "
          "two) it is any smooth curve, drawn by 24 points or more; how much it may "
          "bend is chosen by what the positions tell. With --effects auto of the regions that are "
          "found, if any.",
      .group = "Fit",
      .minimum = 2,
      .maximum = 100};
}

// `fitted` with its boundaries refined, where that is better; in words on standard error.
inline Fit with_refined_boundaries(const Arguments& arguments, const Fit& fitted,
                                   const Experiment& experiment, const TetMesh& body,
                                   const FitOptions& fit_options) {
  BoundaryOptions options;
  options.key_points = static_cast<int>(arguments[flag::boundary]);
  options.threads = static_cast<int>(arguments[flag::threads]);
  options.fit = fit_options;
  Progress progress(arguments, "boundaries, positions solved", 0);
  options.progress = [&progress] { progress.step(); };
  const BoundaryFit refined = refine_boundaries(fitted, experiment, body, options);
  say(arguments, "hs-identify", boundary_words(refined, fitted));
  return refined.fitted;
}

}  // namespace hapsim
