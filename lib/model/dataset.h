// A recording as the model sees it: presses at contact positions.
#pragma once

#include <vector>

#include "effects/effect.h"
#include "io/recording.h"

namespace hapsim {

// Consecutive rows that share a memory: one press, or several at one position when the recording
// says `recovery: none`.
struct Episode {
  int position = 0;
  std::vector<int> rows;  // of the recording
  PressView view;         // normal, direction, past_depth are filled in by set_normals()
};

struct Dataset {
  Recording recording;
  std::vector<Vec3> positions;  // distinct contact points [m]
  std::vector<Episode> episodes;
  std::size_t rows() const { return recording.rows(); }
};

// Contact points closer than `same` are one position. Error(kBadInput) when a press moves its
// contact point by more than that.
Dataset make_dataset(Recording recording, double same = 1e-4);
// Normals by position, and what follows from them: each press's direction and the deepest press
// before it at its place (none with `recovery: full`).
void set_normals(Dataset& dataset, const std::vector<Vec3>& normals);

// Standard deviation of the force noise per component [N]: metadata `force_noise`, or second
// differences in time, median(|d2|) / (0.6745 sqrt 6), pooled over the components.
struct Noise {
  double value = 0;
  bool measured = false;  // from the data, not declared
};
Noise force_noise(const Dataset& dataset);

// The temperature to count from is the metadata `temp_ref`, else the mean.
DataSummary summarise(const Dataset& dataset, double modulus);

}  // namespace hapsim
