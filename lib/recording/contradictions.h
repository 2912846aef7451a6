// What a caller says of a recording, where the recording says otherwise.
#pragma once

#include <string>

#include "recording/recording.h"

namespace hapsim {

// A sentence where the recording's metadata name another radius of the tool; "" where not.
std::string other_radius_words(const Metadata& metadata, double radius, const std::string& name);

// A sentence where the noise is some ten times what the samples scatter, or a tenth of it; "" where
// not. Error(kUsage), beginning with `what`, where the noise is larger than the forces themselves
// (root mean square), so that they would say nothing. A recording without forces says nothing.
std::string other_noise_words(const Recording& recording, double noise, const std::string& what);

}  // namespace hapsim
