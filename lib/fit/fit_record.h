// What is written down of a fit: the model's metadata, and a row of the table of versions.
#pragma once

#include <string>

#include "fit/fit.h"
#include "model/model_history.h"

namespace hapsim {

// The metadata of the model that the fit started from, with the error and the noise of this one,
// and its constraints (all, and those that bind), as --constrain takes them; what was known of the
// start's own fit (held-out errors, marks) goes.
void record_fit(Fit& fitted, const Metadata& start, const Experiment& experiment);

// A version named `model`; `held_out`, of what `by` says, and `force_rms` [N].
HistoryRow history_row(const std::string& model, const Fit& fitted, double held_out,
                       const std::string& by, double noise, double force_rms);

}  // namespace hapsim
