// hs-identify --until: the fit sees the beginning of each press and predicts the rest.
#pragma once

#include <fmt/format.h>

#include <optional>

#include "base/error.h"
#include "cli/tool.h"
#include "experiment/workspace.h"
#include "fit/rest_of_press.h"
#include "identify_recordings.h"

namespace hapsim {

inline Option until_flag() {
  return {.flag = "--until",
          .kind = OptionKind::kTime,
          .value = "S",
          .help =
              "Fits to the first S seconds of each press alone (counted from its first row) "
              "and tells the error on what comes later, its median also over the peak of "
              "the press.",
          .group = "Fit",
          .minimum = 1e-6};
}

// Cuts the experiment; keeps it whole for the error on what comes later.
class Later {
 public:
  Later(const Arguments& arguments, Experiment& experiment) : arguments_(arguments) {
    if (!arguments.given("--until")) return;
    seconds_ = arguments.number("--until");
    whole_ = make_dataset(experiment.recording, experiment.setup_of_row);
    experiment.recording =
        beginning_of_presses(experiment.recording, seconds_, experiment.setup_of_row);
  }

  void tell(Model& model, const Workspace& w) {
    if (!whole_) return;
    set_normals(*whole_, w.body->normals());
    const LaterError error = later_error(model, *whole_, *w.body, seconds_);
    model.metadata.set("until", format_number(seconds_));
    model.metadata.set("heldout_later", format_number(error.rmse));
    say(arguments_, "hs-identify",
        fmt::format("after {:g} s, not seen by the fit: {} samples, error {:.4g} N, median {:.3g} "
                    "% of the peak of the press",
                    seconds_, error.rows, error.rmse, 100 * error.median));
  }

 private:
  const Arguments& arguments_;
  double seconds_ = 0;
  std::optional<Dataset> whole_;
};

}  // namespace hapsim
