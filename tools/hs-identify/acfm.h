// hs-identify --acfm: springs and dashpots at every position, from a recording.
#pragma once

#include <fmt/format.h>

#include "acfm/acfm_fit.h"
#include "acfm/acfm_record.h"
#include "acfm/acfm_summary.h"
#include "answer.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "common_options.h"
#include "hs-identify/flags.h"
#include "hs-identify/plan.h"
#include "hs-identify/recordings.h"
#include "io/stream.h"
#include "marked_points.h"
#include "mesh/signed_distance.h"
#include "recording/force_noise.h"

namespace hapsim {

inline int run_acfm(const Arguments& arguments) {
  for (const AnyFlag& flag :
       AnyFlags{flag::effects,  flag::model,   flag::add,       flag::remove,       flag::diagnosis,
                flag::fix,      flag::free,    flag::regions,   flag::locations,    flag::image,
                flag::lumps,    flag::profile, flag::robust,    flag::history,      flag::terms,
                flag::boundary, flag::library, flag::material,  flag::object,       flag::starts,
                flag::resume,   flag::until,   flag::constrain, flag::region_names, flag::markers})
    if (arguments.given(flag))
      fail_usage(flag + " is of models with effects, and --acfm has none", "leave one of them out");
  ExperimentOptions prepared = preparation_options(arguments);
  const GivenRecordings given = load_recordings(arguments, {}, prepared);
  const Dataset& dataset = given.dataset;
  const SignedDistance surface(boundary_surface(given.bodies.front()), "body");
  require_one_setup(dataset, flag::acfm.name);
  const std::vector<Vec3> normals = contact_normals(dataset, surface);
  AcfmFitOptions options;
  options.terms = static_cast<int>(arguments[flag::acfm]);
  options.stiffening = arguments[flag::stiffening];
  options.folds = static_cast<int>(arguments[flag::folds]);
  options.threads = static_cast<int>(arguments[flag::threads]);
  options.windows = asked_terms(arguments).windows;
  if (!options.windows.empty() && static_cast<int>(options.windows.size()) != options.terms)
    fail_usage(fmt::format("{} windows for {} elements", options.windows.size(), options.terms),
               "give each element one window");
  const Noise noise =
      prepared.noise > 0 ? Noise{prepared.noise, false} : force_noise(dataset.recording);
  options.noise = noise.value;
  AcfmFit fit = fit_acfm(dataset, normals, options);
  record_fit(fit, dataset, noise);
  Output output(result_file(arguments));
  write_acfm(output.stream(), fit.model);
  output.commit();
  Summary summary = acfm_summary(fit, dataset, noise);
  if (arguments.output() != "-" && arguments.input() != "-")
    summary.next = fmt::format("hs-simulate {} --model {} -o forces.csv",
                               shell_quoted(arguments.input()), shell_quoted(arguments.output()));
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace hapsim
