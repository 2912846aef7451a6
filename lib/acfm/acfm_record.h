// What is told of the fit of an analytical model: its metadata, and sentences.
#pragma once

#include <string>
#include <vector>

#include "acfm/acfm_fit.h"
#include "recording/force_noise.h"

namespace hapsim {

// Tool, noise and errors, into the metadata of the model.
void record_fit(AcfmFit& fit, const Dataset& dataset, const Noise& noise);

// What was fitted to what, what had to be taken from elsewhere or is not determined, and the
// errors.
std::vector<std::string> fit_lines(const AcfmFit& fit, const Dataset& dataset, const Noise& noise);

}  // namespace hapsim
