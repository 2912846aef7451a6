// What a table tells beside its presses: the tool's ball, the height of the specimen.
#pragma once

#include <optional>

#include "import/press_track.h"

namespace hapsim {

// Radius of the tool's ball [m]: the median distance of its centre at first contact from the
// contact point, rounded to 10 um; none where the table lacks either or they lie apart by other
// distances.
std::optional<double> ball_radius(const Samples& samples, const std::vector<PressTrack>& tracks);

// Height of the specimen [m]: the gap between the tools at first contact, the median of the
// presses; none without a gap, or where it differs between presses by more than a tenth.
std::optional<double> specimen_height(const Samples& samples,
                                      const std::vector<PressTrack>& tracks);

}  // namespace hapsim
