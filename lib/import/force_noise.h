// The noise of a force sensor, from the recording itself.
#pragma once

#include <string>
#include <vector>

#include "import/press_track.h"

namespace hapsim {

struct NoiseEstimate {
  double sigma = 0;  // standard deviation per component [N]; 0: too few samples
  std::string how;   // "second differences of 12 presses"
};

// The larger of two: differences within presses (blind to slow noise), and the scatter of the
// samples in the air (blind to noise that comes with force). Medians over the presses.
// `along_normal`: the forces have one component. Needs 30 differences in all.
NoiseEstimate estimate_noise(const std::vector<PressTrack>& tracks, bool along_normal);

}  // namespace hapsim
