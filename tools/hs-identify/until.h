// hs-identify --until: the fit sees the beginning of each press and predicts the rest.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "cli/tool.h"
#include "experiment/dataset_parts.h"
#include "experiment/experiment.h"
#include "fit/fit_words.h"
#include "fit/rest_of_press.h"
#include "hs-identify/flags.h"
#include "hs-identify/recordings.h"

namespace hapsim {

inline Option until_flag() {
  return {.flag = flag::until,
          .value = "S",
          .help =
              "Fits to the first S seconds of each press alone (counted from its first row) "
              "and tells the error on what comes later, its median also over the peak of "
              "the press.",
          .group = "Fit",
          .minimum = 1e-6};
}

// Cuts the recordings; keeps them whole for the error on what comes later.
class RestOfPress {
 public:
  RestOfPress(const Arguments& arguments, GivenRecordings& given) {
    if (!arguments.given(flag::until)) return;
    seconds_ = arguments[flag::until];
    Recording beginning =
        beginning_of_presses(given.dataset.recording, seconds_, given.setup_of_row);
    whole_ = std::move(given.dataset);
    given.dataset = make_dataset(std::move(beginning), given.setup_of_row);
  }

  // In words, and into the fitted model; "" without --until.
  std::string tell(Fit& fitted, const Experiment& experiment) {
    if (!whole_) return "";
    Model& model = fitted.model;
    std::vector<std::size_t> kept;  // places at which the tool fits
    for (std::size_t p = 0; p < whole_->positions.size(); ++p)
      if (std::none_of(experiment.unfit.begin(), experiment.unfit.end(),
                       [&](const UnfitPlace& u) { return u.point == whole_->positions[p]; }))
        kept.push_back(p);
    Dataset whole = on_body(at_positions(*whole_, kept), experiment.places.stands());
    whole.label = experiment.dataset.label;
    const LaterError error = later_error(fitted, whole, seconds_);
    whole_.reset();
    model.metadata.set("until", format_number(seconds_));
    model.metadata.set("heldout_later", format_number(error.rmse));
    return later_words(error, seconds_);
  }

 private:
  double seconds_ = 0;
  std::optional<Dataset> whole_;
};

}  // namespace hapsim
