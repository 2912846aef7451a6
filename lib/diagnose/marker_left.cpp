#include "diagnose/marker_left.h"

#include <fmt/format.h>

#include "diagnose/held_out.h"
#include "diagnose/left_over.h"
#include "fit/marker_words.h"

namespace hapsim {
MarkerLeft marker_left(const Fit& fitted, const TrialGround& g, const Markers* markers) {
  MarkerLeft left;
  if (markers == nullptr) return left;
  FitOptions options = trial_fit_options(g);
  options.markers = markers;
  const Fit both = fit(fitted.model, g.experiment, all_episodes(g.dataset), options, fitted.about);
  left.error = both.marker;
  const MarkerError& e = left.error;
  if (e.rows == 0) {
    if (!e.unused.empty()) left.words = "M" + e.unused.substr(1) + ".";
    return left;
  }
  left.force_error = both.error.pooled / fitted.error.pooled;
  const bool points = !marker_explained(e);
  // Beside points the places' errors are free to leave more of the forces, within what mesh and
  // shape are allowed: their plain error says nothing.
  const bool force = left_over(fitted, g).noise_alone() && !left_over(both, g).noise_alone();
  left.off = points || force;
  if (!left.off) return left;
  if (points)
    left.words = fmt::format(
        "marked points of the surface do not move as the model says: {:.3g} mm is left of {:.3g}, "
        "{:.2g} x their noise and {:.2g} x what noise and meshes let it be, most at point {} "
        "({:.3g} mm)",
        1e3 * e.rms, 1e3 * e.size, e.rms / e.noise, e.whitened, e.worst, 1e3 * e.worst_rms);
  else
    left.words = fmt::format(
        "the model has the marked points at the price of the forces alone: their error is {:.2g} "
        "times what it is without points",
        left.force_error);
  left.words +=
      "; look at the shape and the support of the body, at boundaries between regions and layers, "
      "at the camera's frame and clock.";
  return left;
}

}  // namespace hapsim
