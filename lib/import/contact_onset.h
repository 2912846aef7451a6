// Where a tool that approaches through the air first touches.
#pragma once

#include <vector>

namespace hapsim {

struct ContactOnset {
  bool found = false;
  double depth = 0;     // travel at first contact, as `travel` [m]
  double baseline = 0;  // force in the air [N]
  double noise = 0;     // standard deviation of the force [N]
  int air_samples = 0;  // samples of the approach before contact
};

// Change point of one press: f = b for s <= s0, f = b + k (s - s0)^p beyond, by least squares over
// the approach and the first 30 % of the force; p of {1, 1.25, 1.5, 2} by what fits best, so a
// curved toe is not cut off. Where no power
// fits to noise, as before a stiffening body, or the force rises in what would be air, the window
// is halved until it does. Without samples in the air (force at the first sample) b = 0 and s0 is
// extrapolated. travel [m] grows inwards, force [N] grows with it; rows in the order of time. Not
// found when the force never leaves its noise.
ContactOnset find_contact_onset(const std::vector<double>& travel,
                                const std::vector<double>& force);

// Standard deviation of the noise on a smooth series: second differences, MAD / (0.6745 sqrt 6), of
// third differences (sqrt 20) below 20 samples. 0 when there are fewer than 5.
double difference_noise(const std::vector<double>& values);

}  // namespace hapsim
