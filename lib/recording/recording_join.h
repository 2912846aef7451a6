// Several recordings as one.
#pragma once

#include <vector>

#include "recording/recording.h"

namespace hapsim {

// Presses are numbered on, times go on 1 s after the last (each press is relaxed anyway), metadata
// and name are those of the first, force_noise the root mean square of all rows where they declare
// different ones; unknown columns are left out. The rows follow one another in the order of the
// recordings; of their tool radii the first stays. Error(kBadInput) names the file that does not
// fit the first: another tool (flat or sphere), another set of columns, another `recovery`; or
// `recovery: none`, for what the body remembers from one file to the next is not known.
Recording join_recordings(const std::vector<Recording>& recordings);

}  // namespace hapsim
