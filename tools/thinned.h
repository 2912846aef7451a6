// Long recordings, fitted as means of neighbouring rows.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "common_options.h"
#include "marked_points.h"
#include "recording/thinning.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace flag {
inline constexpr IntegerFlag most_rows{"--most-rows"};
}  // namespace flag

inline Option most_rows_flag(const std::string& most) {
  return {.flag = flag::most_rows,
          .value = "N",
          .help =
              "Of a recording with more rows, neighbours in a press become means of 2, 4, 8 ... "
              "while it is read, until N are left at most (or 40 of each press's way through "
              "air or contact, where that is more); what that loses, and the noise that is "
              "left, is said. 0: all rows.",
          .group = "Fit",
          .default_text = most,
          .minimum = 0,
          .maximum = 1e9};
}

// Recordings together of at most --most-rows rows. Where some are thinned and the noise is that of
// --noise, which is a row's, each declares its own and `options` ask for none.
inline std::vector<Recording> load_thinned(const Arguments& arguments, const std::string& tool,
                                           const std::vector<std::string>& paths,
                                           ExperimentOptions& options) {
  constexpr std::size_t kFewest = 1000;  // of one of many recordings
  std::size_t most = static_cast<std::size_t>(arguments[flag::most_rows]);
  most = std::max(std::min(most, kFewest), most / paths.size());
  const double noise = arguments.given(flag::noise) ? arguments[flag::noise] : 0;
  std::vector<Recording> recordings;
  std::vector<Thinning> thinnings;
  bool any = false;
  for (const std::string& path : paths) {
    Input input(path);
    Thinning thinning;
    Recording recording = calibrated(arguments, read_thinned(input, true, most, noise, thinning));
    recordings.push_back(as_asked(arguments, std::move(recording), true,
                                  [&](const std::string& words) { say(arguments, words); }));
    // A mean's unknown columns are those of its first row, and torques are read from these.
    if (thinning.thinned() && has_torques(recordings.back())) {
      forget_torques(recordings.back());
      say(arguments, tool,
          recordings.back().name +
              ": rows are means of several, whose torques are not used (--most-rows 0 uses them)");
    }
    if (thinning.thinned() && arguments.given(flag::markers))
      fail_input(recordings.back().name,
                 "rows would become means of several, between which marked points are not matched",
                 "take all rows (--most-rows 0)");
    any = any || thinning.thinned();
    thinnings.push_back(thinning);
  }
  if (!any) return recordings;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    if (noise > 0 && !thinnings[k].thinned())
      recordings[k].metadata.set("force_noise", format_number(noise));
    if (thinnings[k].thinned())
      say(arguments, tool, recordings[k].name + ": " + thinning_words(thinnings[k]));
  }
  if (noise > 0) options.noise = 0;
  return recordings;
}

}  // namespace hapsim
