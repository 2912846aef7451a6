#include "import/force_noise.h"

#include <fmt/format.h>

#include <cmath>

#include "base/median.h"
#include "import/contact_onset.h"

namespace hapsim {
namespace {

// Root mean square over the axes of what `measure` says of one component.
template <class Measure>
double over_axes(const PressTrack& track, bool along_normal, Measure measure) {
  if (along_normal) return measure(track.force);
  double sum = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vec3& f : track.f) values.push_back(f[axis]);
    const double one = measure(values);
    sum += one * one;
  }
  return std::sqrt(sum / 3);
}

}  // namespace

NoiseEstimate estimate_noise(const std::vector<PressTrack>& tracks, bool along_normal) {
  std::vector<double> differences, air;
  std::size_t samples = 0, short_presses = 0;
  for (const PressTrack& track : tracks) {
    const std::size_t n = track.force.size();
    if (n >= 5) {
      samples += n - 2;
      short_presses += n < 20;
      differences.push_back(over_axes(track, along_normal, difference_noise));
    }
    std::vector<std::size_t> away;
    for (std::size_t i = 0; i < n; ++i)
      if (track.travel[i] < -2e-4) away.push_back(i);
    if (away.size() < 10) continue;
    air.push_back(over_axes(track, along_normal, [&away](const std::vector<double>& values) {
      std::vector<double> some;
      for (const std::size_t i : away) some.push_back(values[i]);
      const double middle = median(some);
      for (double& value : some) value = std::abs(value - middle);
      return median(some) / 0.6745;
    }));
  }
  NoiseEstimate estimate;
  if (samples < 30) return estimate;
  const double by_differences = median(differences);
  const double by_air = air.empty() ? 0 : median(air);
  estimate.sigma = std::max(by_differences, by_air);
  if (by_air > by_differences)
    estimate.how = fmt::format("the samples in the air of {} presses", air.size());
  else if (2 * short_presses > differences.size())
    estimate.how =
        fmt::format("third differences of {} short presses, an upper estimate", differences.size());
  else
    estimate.how = fmt::format("second differences of {} presses", differences.size());
  return estimate;
}

}  // namespace hapsim
