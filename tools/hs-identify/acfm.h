// hs-identify --acfm: springs and dashpots at every position, from a recording.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acfm/acfm_fit.h"
#include "base/error.h"
#include "common_options.h"
#include "hs-identify/plan.h"
#include "hs-identify/recordings.h"
#include "io/stream.h"
#include "mesh/signed_distance.h"
#include "recording/force_noise.h"

namespace hapsim {

inline int run_acfm(const Arguments& arguments) {
  for (const char* flag :
       {"--effects", "--model",   "--add",       "--remove",  "--diagnosis", "--fix",
        "--free",    "--regions", "--locations", "--image",   "--profile",   "--robust",
        "--history", "--terms",   "--boundary",  "--library", "--material",  "--object",
        "--starts",  "--resume",  "--until"})
    if (arguments.given(flag))
      fail_usage(std::string(flag) + " is of models with effects, and --acfm has none",
                 "leave one of them out");
  const GivenRecordings given = load_recordings(arguments);
  const Dataset& dataset = given.dataset;
  const SignedDistance surface(boundary_surface(given.bodies.front()), "body");
  require_one_setup(dataset, "--acfm");
  std::vector<Vec3> normals;
  for (const Vec3& p : dataset.positions) {
    const SurfaceSide side = surface.at(p);
    if (std::abs(side.distance) > 3 * dataset.setups.front().tool_radius)
      fail_input(dataset.recording.name,
                 fmt::format("the contact at ({:.6g}, {:.6g}, {:.6g}) lies {:.3g} m off the "
                             "surface, more than 3 tool radii",
                             p.x(), p.y(), p.z(), std::abs(side.distance)),
                 "check the unit and that the body and the recording share one frame");
    normals.push_back(side.normal);
  }
  AcfmFitOptions options;
  options.terms = static_cast<int>(arguments.integer("--acfm"));
  options.stiffening = arguments.given("--stiffening");
  options.folds = static_cast<int>(arguments.integer("--folds"));
  options.threads = static_cast<int>(arguments.integer("--threads"));
  options.windows = terms_asked(arguments).windows;
  if (!options.windows.empty() && static_cast<int>(options.windows.size()) != options.terms)
    fail_usage(fmt::format("{} windows for {} elements", options.windows.size(), options.terms),
               "give each element one window");
  const Noise noise = arguments.given("--noise") ? Noise{arguments.number("--noise"), false}
                                                 : force_noise(dataset.recording);
  options.noise = noise.value;
  AcfmFit fit = fit_acfm(dataset, normals, options);
  Metadata& metadata = fit.model.metadata;
  metadata.set("tool_radius", format_number(dataset.recording.tool_radius()));
  metadata.set("force_noise", format_number(noise.value));
  metadata.set("rmse", format_number(fit.rmse));
  if (!std::isnan(fit.held_out_presses))
    metadata.set("heldout_presses", format_number(fit.held_out_presses));
  if (!std::isnan(fit.held_out_positions))
    metadata.set("heldout_positions", format_number(fit.held_out_positions));
  Output output(arguments.output());
  write_acfm(output.stream(), fit.model);
  output.commit();

  const auto line = [&](const std::string& text) { say(arguments, "hs-identify", text); };
  double squares = 0;
  for (const Vec3& f : dataset.recording.f) squares += f.squaredNorm();
  const double force = std::sqrt(squares / (3 * static_cast<double>(dataset.rows())));
  const auto error = [&](double value) {
    return fmt::format("{:.4g} N = {:.3g} % of the force's rms, {:.3g} x noise", value,
                       100 * value / force, value / noise.value);
  };
  line(
      fmt::format("{} sub-models of {} Maxwell elements a direction from {} samples; noise {:.3g} "
                  "N ({})",
                  dataset.positions.size(), options.terms, dataset.rows(), noise.value,
                  noise.measured ? "measured from the data" : "declared"));
  if (fit.derived_axes > 0)
    line(
        fmt::format("{} of {} directions are not moved in these data: taken from the others by "
                    "the ratio of a bonded disc",
                    fit.derived_axes, 3 * dataset.positions.size()));
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min(kMost, fit.remarks.size()); ++i) line(fit.remarks[i]);
  if (fit.remarks.size() > kMost) line(fmt::format("... and {} more", fit.remarks.size() - kMost));
  line("error " + error(fit.rmse));
  if (!std::isnan(fit.held_out_presses))
    line("on presses not seen by the fit " + error(fit.held_out_presses));
  if (!std::isnan(fit.held_out_positions))
    line("at positions interpolated from the others " + error(fit.held_out_positions));
  return 0;
}

}  // namespace hapsim
