// The noise of the forces of a recording: declared, or measured from the recording itself.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "recording/recording.h"

namespace hapsim {

struct NoiseEstimate {
  // Standard deviation of a component that was measured (root mean square over them) [N]; 0: no
  // press has three rows.
  double sigma = 0;
  // The same of the force along the press [N]: larger where only that was measured and it has
  // several components, as with a load cell of one axis on a curved body.
  double along = 0;
  std::size_t differences = 0;  // that went into it
  std::string how;              // "second differences of 12 presses"
};

// From the differences of neighbours in time: a smooth force has small ones, and white noise of
// standard deviation s has second differences of sqrt(6) s and third ones of sqrt(20) s, so
// s = median(|d|) / (0.6745 sqrt 6) over all presses, of each measured component. Where most
// presses have fewer than 20 rows it is third differences, which a force that bends between its
// rows changes less. Where every press has forces along one line, the force along that line is what
// was measured. Forces rounded to steps q have ties, over which the median is interpolated (right
// to some 30 % where q is larger than the noise), and at least the error of rounding, q / sqrt 12.
//
// Differences do not see slow noise. The scatter of the samples in the air (at least 0.2 mm off the
// contact, 10 in a press) does, and is taken when it is larger by more than chance.
//
// What is left below 1e-6 of the largest force is no measurement; it counts as 1e-4 of that.
NoiseEstimate measure_force_noise(const Recording& recording);

struct Noise {
  double value = 0;              // standard deviation per component [N]
  bool measured = false;         // from the data, not declared
  std::string origin = "given";  // for sentences: "estimated from second differences of 12 presses"
  // Steps to which a sensor rounds forces, where these make up most of the noise [N]; 0: none do.
  double step = 0;
};

// The metadata force_noise, and the error of rounding, step / sqrt 12, beside it where that is more
// than a quarter of it: a datasheet's noise knows nothing of a converter's steps. They are told
// from the slopes of smooth data by forces that stay while the tool moves. Origin: "declared"; or,
// of what hs-import has measured with the rounding in it (metadata force_noise_from), "estimated
// from
// ...".
std::optional<Noise> declared_noise(const Recording& recording);

// Both are of forces that are no longer there.
void forget_force_noise(Metadata& metadata);

// declared_noise(), else measured; 1e-4 of the largest force where no press has three
// rows.
Noise force_noise(const Recording& recording);

}  // namespace hapsim
