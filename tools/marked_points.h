// Marked points of the surface beside a recording: the option and its table.
#pragma once

#include <optional>

#include "cli/tool.h"
#include "experiment/markers.h"

namespace hapsim {
namespace flag {
inline constexpr FileFlag markers{"--markers"};
}  // namespace flag

inline Option markers_option(const std::string& help, const std::string& group = "Input") {
  return {.flag = flag::markers, .value = "FILE", .help = help, .group = group};
}

// What a table of marked points is, for a man page.
inline std::vector<std::pair<std::string, std::string>> marker_columns() {
  return {{"point", "name of the marked point"},
          {"t", "time by the recording's clock [s]"},
          {"x, y, z",
           "where it lies on the unpressed body, in its frame [m]; the same in all of "
           "its rows"},
          {"ux, uy, uz", "displacement from there [m]"},
          {"press", "the recording's press; needed where its times begin anew with each"},
          {"# marker_noise",
           "standard deviation of a component [m]; else it is measured as what "
           "is left of the best proportion to the tool's displacement"},
          {"units", "in the header where they are others: ux_mm, 'x [mm]', t_ms"}};
}

// Read before anything is prepared.
inline std::optional<MarkerTable> asked_markers(const Arguments& arguments,
                                                bool need_motion = true) {
  if (!arguments.given(flag::markers)) return std::nullopt;
  Input input(arguments[flag::markers]);
  return read_markers(input, need_motion);
}

// Beside a prepared recording; what counts is said.
inline std::optional<Markers> matched(const Arguments& arguments, const std::string& tool,
                                      const std::optional<MarkerTable>& table,
                                      const Experiment& experiment) {
  if (!table) return std::nullopt;
  Markers markers = match_markers(*table, experiment);
  for (const std::string& words : markers.words) say(arguments, tool, table->name + ": " + words);
  return markers;
}

}  // namespace hapsim
