// Flags that the tools with a body and a recording share.
#pragma once

#include <fmt/format.h>

#include <fstream>

#include "calibration_option.h"
#include "cli/shared_flags.h"
#include "cli/tool.h"
#include "experiment/contact_radius.h"
#include "experiment/experiment.h"
#include "experiment/plausible.h"
#include "experiment/preparation_flags.h"
#include "formats/format_table.h"
#include "formats/tetmesh_io.h"
#include "mesh/tetmesh.h"
#include "model/search_state.h"
#include "recording/contradictions.h"
#include "recording/recording.h"
#include "recording/tools_together.h"

namespace hapsim {

inline std::vector<Option> experiment_flags() {
  std::vector<Option> flags{
      {.flag = flag::body,
       .value = "FILE",
       .help = "Body from hs-tetmesh, or another mesh of tetrahedra with fixed nodes: " +
               names_to_read(Content::kTetrahedra) + ".",
       .group = "Input",
       .required = true},
      calibration_option("Input")};
  for (const Option& option : preparation_flags()) flags.push_back(option);
  return flags;
}

inline Recording load_recording(const Arguments& arguments, const std::string& path, bool forces) {
  Input input(path);
  return as_asked(arguments, read_measured(arguments, input, forces), forces,
                  [&](const std::string& words) { say(arguments, words); });
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
  for (const std::string& words : doubts_of(model)) say(arguments, tool, words);
  return model;
}
inline Model load_model(const Arguments& arguments, const std::string& tool) {
  Input input(arguments[flag::model]);
  return load_model(arguments, tool, input);
}

// What of a model acts nowhere on this body.
inline void say_idle(const Arguments& arguments, const std::string& tool, const Model& model,
                     const TetMesh& body) {
  for (const std::string& words : doubts_of(model, std::span(&body, 1)))
    say(arguments, tool, words);
}

// With progress on a terminal while positions are prepared.
inline ExperimentOptions experiment_options(const Arguments& arguments,
                                            std::shared_ptr<Progress>& progress) {
  ExperimentOptions options = preparation_options(arguments);
  options.progress = [&arguments, &progress](std::size_t positions) -> std::function<void()> {
    progress = std::make_shared<Progress>(arguments, "contact positions", positions);
    return [&progress] {
      if (progress) progress->step();  // later solutions, once the line is cleared, are silent
    };
  };
  return options;
}

}  // namespace hapsim
