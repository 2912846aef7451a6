// --calibration: measured recordings are read here, by all tools, and put right.
#pragma once

#include "base/shell_words.h"
#include "cli/tool.h"
#include "recording/recording.h"
#include "rig/correct.h"

namespace hapsim {

namespace flag {
inline constexpr FileFlag calibration{"--calibration"};
}  // namespace flag

inline Option calibration_option(const std::string& group) {
  return {.flag = flag::calibration,
          .value = "FILE",
          .help =
              "Calibration of the rig from hs-calibrate: takes out the sensor's cross-talk, "
              "rotation, offset and drift, the tool's weight (columns of the tool's "
              "orientation), and what the arm gave way.",
          .group = group};
}

inline Calibration load_calibration(const Arguments& arguments) {
  Input input(arguments[flag::calibration]);
  return read_calibration(input);
}

// " --calibration FILE" of a next command, where this one has it.
inline std::string calibration_words(const Arguments& arguments) {
  return arguments.given(flag::calibration)
             ? " --calibration " + shell_quoted(arguments[flag::calibration])
             : "";
}

// A measured recording as it is to be used; what was done to it is said.
inline Recording calibrated(const Arguments& arguments, Recording recording) {
  if (!arguments.given(flag::calibration) || recording.f.empty()) return recording;
  const Calibration calibration = load_calibration(arguments);
  const RigCorrection correction = calibrate_recording(calibration, recording);
  for (const std::string& words : correction_words(calibration, correction))
    say(arguments, recording.name + ": " + words);
  return recording;
}

inline Recording read_measured(const Arguments& arguments, Input& input, bool need_forces = true) {
  return calibrated(arguments, read_recording(input, need_forces));
}

}  // namespace hapsim
