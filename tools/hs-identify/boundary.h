// hs-identify --boundary: the boundaries between regions move with their moduli.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cli/tool.h"
#include "experiment/experiment.h"
#include "fit/boundary_fit.h"

namespace hapsim {

inline Option boundary_flag() {
  return {.flag = "--boundary",
          .kind = OptionKind::kInteger,
          .value = "N",
          .help =
              "Refines the boundaries between the regions in turn with their moduli: N key "
              "points along each move across it, as the forces along and across the surface "
              "ask.",
          .group = "Fit",
          .minimum = 2,
          .maximum = 100};
}

// `fitted` with its boundaries refined, where that is better; in words on standard error.
inline Fit with_refined_boundaries(const Arguments& arguments, const Fit& fitted,
                                   const Experiment& experiment, const TetMesh& body,
                                   const FitOptions& fit_options) {
  BoundaryOptions options;
  options.key_points = static_cast<int>(arguments.integer("--boundary"));
  options.threads = static_cast<int>(arguments.integer("--threads"));
  options.fit = fit_options;
  Progress progress(arguments, "boundaries, positions solved", 0);
  options.progress = [&progress] { progress.step(); };
  const BoundaryFit refined = refine_boundaries(fitted, experiment, body, options);
  if (!refined.better) {
    say(arguments, "hs-identify", "the boundaries stay: moving them does not lower the error");
    return refined.fitted;
  }
  double squares = 0;
  for (const double d : refined.moved) squares += d * d / static_cast<double>(refined.moved.size());
  say(arguments, "hs-identify",
      fmt::format("boundaries moved by {:.2g} mm (rms), at most {:.2g} mm; error {:.4g} N before; "
                  "their points are known to {:.2g} to {:.2g} mm",
                  1e3 * std::sqrt(squares),
                  1e3 * *std::max_element(refined.moved.begin(), refined.moved.end()),
                  fitted.error.told(),
                  1e3 * *std::min_element(refined.error.begin(), refined.error.end()),
                  1e3 * *std::max_element(refined.error.begin(), refined.error.end())));
  return refined.fitted;
}

}  // namespace hapsim
