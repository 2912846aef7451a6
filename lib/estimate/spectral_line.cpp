#include "estimate/spectral_line.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr double kChance = 1e-3;
constexpr std::size_t kFewest = 100, kMostPoints = 1UL << 18, kBlock = 128;

// The series on even steps, and the bins of its transform in which a line may be.
struct Grid {
  double start = 0, step = 0;
  std::size_t points = 0;
  std::size_t low = 0, high = 0;
  double frequency(std::size_t bin) const {
    return static_cast<double>(bin) / (static_cast<double>(points) * step);
  }
};

Grid make_grid(const std::vector<double>& t, double samples) {
  constexpr double kPeriods = 4;
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i)
    if (t[i] > t[i - 1]) steps.push_back(t[i] - t[i - 1]);
  const auto [first, last] = std::minmax_element(t.begin(), t.end());
  const double length = *last - *first;
  Grid grid;
  if (steps.empty() || length <= 0) return grid;
  grid.start = *first;
  grid.step = std::max(upper_median(steps), length / (0.75 * static_cast<double>(kMostPoints)));
  for (grid.points = 1; static_cast<double>(grid.points) * grid.step < 1.25 * length;)
    grid.points *= 2;
  const double bins = static_cast<double>(grid.points) * grid.step;
  grid.low = static_cast<std::size_t>(std::ceil(kPeriods * bins / length));
  // Beside half the samples' own rate power is what differs from one sample to the next.
  grid.high = std::min(static_cast<std::size_t>(static_cast<double>(grid.points) / samples),
                       grid.points / 2 - std::min(grid.low, grid.points / 2));
  return grid;
}

// Power of the bins from low on, which noise without colour makes 1 on the average.
std::vector<double> power_of(const std::vector<double>& t, const std::vector<double>& values,
                             const Grid& grid) {
  std::vector<double> even(grid.points, 0.0);
  double square = 0, mean = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double v = values[i] - mean;
    even[static_cast<std::size_t>(std::lround((t[i] - grid.start) / grid.step))] += v;
    square += v * v;
  }
  std::vector<std::complex<double>> transform;
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.fwd(transform, even);
  std::vector<double> power;
  for (std::size_t k = grid.low; k <= grid.high; ++k)
    power.push_back(square > 0 ? std::norm(transform[k]) / square : 0);
  return power;
}

// Mean power about each bin: the largest of its block's and the neighbours', from medians, on which
// a line has no weight.
std::vector<double> level_of(const std::vector<double>& power) {
  std::vector<double> blocks;
  for (std::size_t k = 0; k < power.size(); k += kBlock) {
    const std::size_t end = std::min(power.size(), k + kBlock);
    std::vector<double> part(power.begin() + static_cast<std::ptrdiff_t>(k),
                             power.begin() + static_cast<std::ptrdiff_t>(end));
    blocks.push_back(upper_median(part) / std::log(2.0));
  }
  std::vector<double> level(power.size());
  for (std::size_t k = 0; k < power.size(); ++k) {
    const std::size_t b = k / kBlock;
    level[k] = blocks[b];
    if (b > 0) level[k] = std::max(level[k], blocks[b - 1]);
    if (b + 1 < blocks.size()) level[k] = std::max(level[k], blocks[b + 1]);
  }
  return level;
}

// Its sine and cosine by least squares.
void fit_waves(const std::vector<double>& t, const std::vector<Vec3>& values, SpectralLine& line) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero(), b = A;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double angle = 2 * M_PI * line.frequency * t[i];
    const Eigen::Vector3d waves(std::sin(angle), std::cos(angle), 1);
    A += waves * waves.transpose();
    b += waves * values[i].transpose();
  }
  const Eigen::Matrix3d x = A.ldlt().solve(b);
  line.sine = x.row(0);
  line.cosine = x.row(1);
}

}  // namespace

SpectralLine find_line(const std::vector<double>& t, const std::vector<Vec3>& values,
                       std::size_t parts, double samples) {
  constexpr double kOfParts = 0.4;
  SpectralLine line;
  if (t.size() < kFewest) return line;
  const Grid grid = make_grid(t, samples);
  if (grid.points == 0 || grid.high <= grid.low) return line;
  const double least = std::log(3 * static_cast<double>(grid.high - grid.low) / kChance);
  double most = std::min(least, kOfParts * static_cast<double>(parts));
  for (int k = 0; k < 3; ++k) {
    std::vector<double> component;
    for (const Vec3& v : values) component.push_back(v[k]);
    const std::vector<double> power = power_of(t, component, grid), level = level_of(power);
    for (std::size_t i = 0; i < power.size(); ++i) {
      if (power[i] < least || power[i] < most * level[i]) continue;
      most = power[i] / level[i];
      line.frequency = grid.frequency(grid.low + i);
    }
  }
  if (line.frequency == 0) return line;
  line.resolution = grid.frequency(1);
  fit_waves(t, values, line);
  return line;
}

}  // namespace hapsim
