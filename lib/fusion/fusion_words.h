// A fusion in short sentences.
#pragma once

#include <string>
#include <vector>

#include "fusion/fuse_recordings.h"

namespace hapsim {

// How many slow forces were of use, and whether the filter knew its own error.
std::string fusion_words(const FusionReport& report);

// The fused forces, and what else could have been given out, beside the exact ones: a line each.
// Error(kBadInput): `exact` has not the rows of `fast`.
std::vector<std::string> quality_lines(const Recording& fast, const FusedForces& fused,
                                       const Recording& exact);

}  // namespace hapsim
