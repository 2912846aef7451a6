// Flags that the tools with a body and a recording share.
#pragma once

#include <fmt/format.h>

#include <fstream>

#include "calibration_option.h"
#include "cli/tool.h"
#include "experiment/contact_radius.h"
#include "experiment/experiment.h"
#include "experiment/plausible.h"
#include "formats/format_table.h"
#include "formats/tetmesh_io.h"
#include "mesh/tetmesh.h"
#include "model/search_state.h"
#include "recording/contradictions.h"
#include "recording/recording.h"
#include "recording/tools_together.h"
#include "shared_flags.h"

namespace hapsim {

inline std::vector<Option> experiment_flags() {
  return {
      {.flag = flag::body,
       .value = "FILE",
       .help = "Body from hs-tetmesh, or another mesh of tetrahedra with fixed nodes: " +
               names_to_read(Content::kTetrahedra) + ".",
       .group = "Input",
       .required = true},
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Radius of the flat tool [m]; otherwise the recording's metadata tool_radius.",
       .group = "Input",
       .minimum = 1e-6,
       .maximum = 1},
      calibration_option("Input"),
      {.flag = flag::noise,
       .value = "N",
       .help = "Standard deviation of the force noise per component [N]; otherwise the metadata "
               "force_noise, otherwise measured from differences of neighbours in time and the "
               "samples in the air.",
       .group = "Fit",
       .minimum = 1e-12},
      {.flag = flag::floor,
       .value = "SHARE",
       .help = "Gain error by position that mesh and scanned shape may cause and no effect is "
               "blamed for; otherwise the mesh's own uncertainty and that of a surface off the "
               "contact points, at least 0.01.",
       .group = "Fit",
       .minimum = 0,
       .maximum = 1},
      {.flag = flag::rim_edge,
       .value = "SHARE",
       .help = "Edge length of the finer contact mesh at the tool's rim, as a share of the radius; "
               "otherwise a sixth.",
       .group = "Fit",
       .minimum = 0.02,
       .maximum = 0.5},
      {.flag = flag::threads,
       .value = "N",
       .help = "Contact positions solved side by side; 0: as many as the machine has cores.",
       .group = "General",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1024},
      {.flag = flag::cache,
       .value = "DIR",
       .help = "Where prepared stiffnesses are kept by content ('none': nowhere); otherwise the "
               "user's cache folder.",
       .group = "General"},
  };
}

inline void say_other_radius(const Arguments& arguments, const Metadata& metadata,
                             const std::string& name) {
  const std::string words = other_radius_words(metadata, arguments[flag::tool_radius], name);
  if (!words.empty()) say(arguments, words);
}

inline Recording load_recording(const Arguments& arguments, const std::string& path, bool forces) {
  Input input(path);
  Recording recording = read_measured(arguments, input, forces);
  if (arguments.given(flag::tool_radius)) {
    say_other_radius(arguments, recording.metadata, recording.name);
    recording.metadata.set("tool_radius", arguments.text(flag::tool_radius));
  }
  recording.tool_radius();  // fails now when it is missing
  if (forces && arguments.given(flag::noise))
    if (const std::string words =
            other_noise_words(recording, arguments[flag::noise], flag::noise.name);
        !words.empty())
      say(arguments, words);
  return recording;
}

// A recording to press the model's body as the model says.
inline Recording load_pressed(const Arguments& arguments, const std::string& path, bool forces,
                              const Model& model) {
  Recording recording = load_recording(arguments, path, forces);
  set_contact_radius(recording, model);
  return recording;
}

// For who takes each tool's press by itself.
inline void say_together(const Arguments& arguments, const std::string& tool,
                         const Recording& recording) {
  if (const std::string text = tools_together(recording); !text.empty()) say(arguments, tool, text);
}

inline TetMesh load_body(const Arguments& arguments, std::vector<Vec3>* window = nullptr) {
  Input input(arguments[flag::body]);
  return read_body(input, window);
}

// A model; says so when its fit was ended early.
inline Model load_model(const Arguments& arguments, const std::string& tool, Input& input) {
  Model model = read_model(input);
  if (is_unfinished(model))
    say(arguments, tool, input.name() + ": the fit of this model was ended before it converged");
  for (const int region : idle_regions(model))
    say(arguments, tool,
        fmt::format("{}: elastic E of region {} acts nowhere: no row of the effect regions gives "
                    "that region a place",
                    input.name(), region));
  if (const auto what = model.metadata.find("interrupted"))
    say(arguments, tool, input.name() + ": interrupted " + *what + ", so more may be missing");
  return model;
}
inline Model load_model(const Arguments& arguments, const std::string& tool) {
  Input input(arguments[flag::model]);
  return load_model(arguments, tool, input);
}

// With progress on a terminal while positions are prepared.
inline ExperimentOptions experiment_options(const Arguments& arguments,
                                            std::shared_ptr<Progress>& progress) {
  ExperimentOptions options;
  options.threads = static_cast<int>(arguments[flag::threads]);
  if (arguments.given(flag::rim_edge)) options.rim_edge = arguments[flag::rim_edge];
  if (arguments.given(flag::noise)) options.noise = arguments[flag::noise];
  if (arguments.given(flag::floor)) options.floor = arguments[flag::floor];
  options.cache = arguments.given(flag::cache) ? arguments[flag::cache] : default_cache_directory();
  if (options.cache == "none") options.cache.clear();
  options.progress = [&arguments, &progress](std::size_t positions) -> std::function<void()> {
    progress = std::make_shared<Progress>(arguments, "contact positions", positions);
    return [&progress] {
      if (progress) progress->step();  // later solutions, once the line is cleared, are silent
    };
  };
  return options;
}

}  // namespace hapsim
