// hs-identify --acfm: springs and dashpots at every position, from a recording.
#pragma once

#include <fmt/format.h>

#include "acfm/acfm_fit.h"
#include "acfm/acfm_record.h"
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
  const std::vector<Vec3> normals = contact_normals(dataset, surface);
  AcfmFitOptions options;
  options.terms = static_cast<int>(arguments.integer("--acfm"));
  options.stiffening = arguments.given("--stiffening");
  options.folds = static_cast<int>(arguments.integer("--folds"));
  options.threads = static_cast<int>(arguments.integer("--threads"));
  options.windows = asked_terms(arguments).windows;
  if (!options.windows.empty() && static_cast<int>(options.windows.size()) != options.terms)
    fail_usage(fmt::format("{} windows for {} elements", options.windows.size(), options.terms),
               "give each element one window");
  const Noise noise = arguments.given("--noise") ? Noise{arguments.number("--noise"), false}
                                                 : force_noise(dataset.recording);
  options.noise = noise.value;
  AcfmFit fit = fit_acfm(dataset, normals, options);
  record_fit(fit, dataset, noise);
  Output output(arguments.output());
  write_acfm(output.stream(), fit.model);
  output.commit();
  for (const std::string& line : fit_lines(fit, dataset, noise))
    say(arguments, "hs-identify", line);
  return 0;
}

}  // namespace hapsim
