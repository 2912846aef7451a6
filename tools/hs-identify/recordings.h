// What hs-identify is given to fit: recordings, each of a body pressed with a tool.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/error.h"
#include "common_options.h"
#include "experiment/plausible.h"
#include "formats/tetmesh_io.h"
#include "hs-identify/flags.h"
#include "hs-identify/plan.h"
#include "identify/given_recordings.h"
#include "recording/torque_columns.h"
#include "thinned.h"

namespace hapsim {

inline std::vector<Option> recording_flags() {
  return {{.flag = flag::data,
           .value = "FILE",
           .help = "One more recording, fitted together with the first; may be given several "
                   "times. Another tool_radius is another tool on the same material.",
           .group = "Input",
           .repeatable = true},
          {.flag = flag::body,
           .value = "FILE",
           .help = "Body from hs-tetmesh, or another mesh of tetrahedra with fixed nodes: " +
                   names_to_read(Content::kTetrahedra) +
                   ". Once: the "
                   "body of all recordings; or once for each recording, in their order (the main "
                   "input, then --data): bodies of one material.",
           .group = "Input",
           .required = true,
           .repeatable = true}};
}

// Error(kUsage) when there is neither one body nor one for each recording; Error(kBadInput) for a
// recording whose presses cannot be what they claim (require_presses()). `start`: the model that is
// gone on with, empty without. `options` know no noise where the recordings declare it.
inline GivenRecordings load_recordings(const Arguments& arguments, const Model& start,
                                       ExperimentOptions& options) {
  std::vector<std::string> paths = arguments.list(flag::data);
  paths.insert(paths.begin(), arguments.input());
  const std::vector<std::string> bodies = arguments.list(flag::body);
  require_bodies_for(bodies.size(), paths.size());
  GivenRecordings given;
  std::vector<int> body_of;  // by --body: the same file is the same body
  std::vector<std::string> read;
  for (const std::string& path : bodies) {
    std::size_t k = 0;
    const auto same = [&](const std::string& other) {
      std::error_code error;
      return path == other || std::filesystem::equivalent(path, other, error);
    };
    while (k < read.size() && !same(read[k])) ++k;
    body_of.push_back(static_cast<int>(k));
    if (k < read.size()) continue;
    read.push_back(path);
    Input input(path);
    given.windows.emplace_back();
    given.bodies.push_back(read_body(input, &given.windows.back()));
  }
  std::vector<Recording> recordings = load_thinned(arguments, "hs-identify", paths, options);
  if (arguments[flag::ignore_torques])
    for (Recording& recording : recordings) forget_torques(recording);
  body_of.resize(paths.size(), body_of.front());
  join_given(given, body_of, std::move(recordings), start);
  return given;
}

// Refuses, before anything is prepared, too few places, and features of one body and tool where
// there are several.
inline void require_fit_for(const Arguments& arguments, const FitRequest& plan,
                            const Dataset& dataset) {
  for (const AnyFlag& flag : AnyFlags{flag::boundary, flag::image, flag::lumps, flag::library})
    if (arguments.given(flag)) require_one_setup(dataset, flag.name);
  for (const AnyFlag& flag : AnyFlags{flag::boundary, flag::image, flag::lumps})
    if (arguments.given(flag) && dataset.positions.size() < 4)
      fail_input(dataset.recording.name, flag + " needs presses at four places or more",
                 "press at more places");
  if (arguments.given(flag::locations) && dataset.bodies() > 1)
    fail_usage("--locations is for one body, and there are several", "fit each body by itself");
  require_fit_for(plan, dataset);
}

}  // namespace hapsim
