// What hs-identify says of a fit.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "cli/tool.h"
#include "estimate/identifiability.h"
#include "experiment/experiment.h"
#include "experiment/plausible.h"
#include "fit/fit.h"
#include "fit/maxwell_terms.h"
#include "linalg/blas.h"
#include "model/body_parameters.h"

namespace hapsim {

// " of 2 bodies by 3 tools"; empty for one of each.
inline std::string setups_in_words(const Dataset& dataset) {
  std::string text;
  if (dataset.bodies() > 1) text += fmt::format(" of {} bodies", dataset.bodies());
  if (dataset.tools() > 1) text += fmt::format(" by {} tools", dataset.tools());
  return text;
}

// Moduli whose standard error is more than half their value, and a Poisson's ratio known to no
// better than half its range.
inline std::vector<std::string> hardly_known(const Model& model) {
  constexpr double kHalf = 0.5, kHalfRange = 0.25;
  std::vector<std::string> names;
  for (const Parameter& p : model.parameters) {
    if (p.state != ParameterState::kFree) continue;
    const bool modulus = p.unit == "Pa", nu = is_poissons_ratio(p);
    if ((modulus && p.std_error > kHalf * p.value) || (nu && p.std_error > kHalfRange))
      names.push_back(p.effect + " " + p.name);
  }
  return names;
}

inline void report(const Arguments& arguments, const Experiment& w, const Fit& result,
                   double held_out, const std::string& by, double force_rms) {
  const auto line = [&](const std::string& text) { say(arguments, "hs-identify", text); };
  line(fmt::format("{} at {}{}, {}; noise {:.3g} N ({}), force rms {:.3g} N",
                   counted(w.dataset.recording.presses().size(), "press", "presses"),
                   counted(w.dataset.positions.size(), "position", "positions"),
                   setups_in_words(w.dataset), counted(w.dataset.rows(), "sample", "samples"),
                   w.noise.value, w.noise.measured ? "measured from the data" : "declared",
                   force_rms));
  if (const std::string shape = w.shape.words(); !shape.empty()) line(shape);
  int shown = 0;
  for (const Parameter& p : result.model.parameters) {
    if (p.state != ParameterState::kFree || ++shown > 12) continue;
    line(fmt::format(
        "{} {}{} = {:.4g} {} ± {}", p.effect, p.name,
        p.region > 0 ? fmt::format(" (region {})", p.region) : "", p.value,
        p.unit == "1" ? "" : p.unit,
        std::isnan(p.std_error) ? "not estimated" : fmt::format("{:.2g}", p.std_error)));
  }
  if (shown > 12) line(fmt::format("... and {} more free parameters", shown - 12));
  const auto warn = [&](const std::vector<std::string>& names, const char* what) {
    constexpr std::size_t kMost = 4;
    for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i) line(names[i] + what);
    if (names.size() > kMost) line(fmt::format("... and {} more", names.size() - kMost));
  };
  warn(result.at_bound,
       " is at its bound: the data ask for more than the model can give, or cannot tell");
  warn(result.undetermined, " is not determined by these data: fix it, or press where it matters");
  warn(hardly_known(result.model),
       " is hardly known (standard error of half its value or range): fix it, or press at more "
       "places and "
       "sideways");
  if (w.dataset.positions.size() == 1)
    line("all presses are at one place: how the body differs from place to place is not seen");
  if (const std::string strange = strange_modulus(result.model); !strange.empty()) line(strange);
  for (const std::string& sentence : result.blind) line(sentence);
  for (const std::string& sentence : untold_times(result.model, w.dataset)) line(sentence);
  for (const std::string& interval : result.intervals) line(interval);
  if (result.discounted > 0)
    line(fmt::format("{} of {} force components discounted as far off", result.discounted,
                     result.residuals));
  if (!enough_data(result.residuals,
                   static_cast<Eigen::Index>(result.model.free_parameters().size())))
    line("fewer than ten force components a free parameter: noise may decide their values");
  const double error = result.error.told();
  line(fmt::format("error {:.4g} N = {:.3g} % of the force's rms, {:.3g} x noise", error,
                   100 * error / force_rms, error / w.noise.value));
  if (!by.empty() && !std::isnan(held_out))
    line(fmt::format("on {} not seen by the fit {:.4g} N = {:.3g} %, {:.3g} x noise", by, held_out,
                     100 * held_out / force_rms, held_out / w.noise.value));
  if (arguments.verbose()) line("BLAS: " + blas_name());
}

}  // namespace hapsim
