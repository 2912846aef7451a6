#include "recording/force_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/counted.h"
#include "base/median.h"

namespace hapsim {
namespace {

constexpr double kNormalMedian = 0.6745;  // median(|x|) of a normal deviate over its deviation
constexpr std::size_t kLong = 20;         // rows of a press from which second differences do
constexpr double kCollinear = 1e-5;       // of the press's largest force: the rounding of tables
constexpr double kInAir = 2e-4;           // [m] off the contact
constexpr std::size_t kFewestInAir = 10;
// The two estimates of white noise differ by less than this over the root of the samples in the
// air: twice their common standard error, 1.2 of the scatter's and some 1.5 of the differences'.
constexpr double kChance = 4;
constexpr double kNothing = 1e-6, kLeast = 1e-4;  // of the largest force

using Series = std::vector<double>;

// One press: what was measured of its force, and which of its rows are in the air.
struct PressForces {
  std::vector<Series> series;
  std::vector<std::size_t> air;
};

double peak_of(const Recording& r) {
  double peak = 0;
  for (const Vec3& f : r.f) peak = std::max(peak, f.norm());
  return peak;
}

int row_of_largest(const std::vector<Vec3>& f, const std::vector<int>& rows) {
  return *std::max_element(rows.begin(), rows.end(),
                           [&f](int a, int b) { return f[a].squaredNorm() < f[b].squaredNorm(); });
}

// The direction of the press's forces, if they lie along one line.
bool is_collinear(const std::vector<Vec3>& f, const std::vector<int>& rows, Vec3& along) {
  const Vec3 top = f[row_of_largest(f, rows)];
  if (top.norm() == 0) return true;  // any line will do
  along = top.normalized();
  return std::all_of(rows.begin(), rows.end(), [&](int row) {
    return (f[row] - along * along.dot(f[row])).norm() <= kCollinear * top.norm();
  });
}

std::vector<std::size_t> rows_in_air(const Recording& r, const std::vector<int>& rows) {
  if (r.u.empty()) return {};
  const Vec3 inward = r.u[row_of_largest(r.f, rows)];
  std::vector<std::size_t> air;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (r.u[rows[i]].dot(inward) < -kInAir * inward.norm()) air.push_back(i);
  return air;
}

std::vector<PressForces> forces_of(const Recording& r, bool& one_line) {
  const std::vector<Press> presses = r.presses();
  std::vector<Vec3> lines(presses.size(), Vec3::UnitZ());
  one_line = true;
  for (std::size_t p = 0; p < presses.size() && one_line; ++p)
    one_line = is_collinear(r.f, presses[p].rows, lines[p]);
  Vec3 largest = Vec3::Zero();
  for (const Vec3& f : r.f) largest = largest.cwiseMax(f.cwiseAbs());
  std::vector<PressForces> all;
  for (std::size_t p = 0; p < presses.size(); ++p) {
    PressForces press;
    const auto add = [&](const Vec3& direction) {
      press.series.emplace_back();
      for (const int row : presses[p].rows) press.series.back().push_back(r.f[row].dot(direction));
    };
    if (one_line) add(lines[p]);
    for (int k = 0; k < 3 && !one_line; ++k)
      if (largest[k] > 0) add(Vec3::Unit(k));
    press.air = rows_in_air(r, presses[p].rows);
    all.push_back(std::move(press));
  }
  return all;
}

// One measured component of all presses.
struct Component {
  const std::vector<PressForces>& presses;
  std::size_t axis;
  const Series& of(const PressForces& press) const { return press.series[axis]; }
};

// The step to which forces are rounded; 0 when their differences are not multiples of one.
double step_of(const Component& component, double peak) {
  constexpr double kSame = 1e-9;      // of the peak: the same force, but for its last digits
  constexpr double kMultiple = 0.01;  // of a step
  constexpr double kFar = 20;         // steps; beyond them the digits of one do not reach
  std::vector<double> steps;
  for (const PressForces& press : component.presses) {
    const Series& v = component.of(press);
    for (std::size_t i = 1; i < v.size(); ++i)
      if (const double d = std::abs(v[i] - v[i - 1]); d > kSame * peak) steps.push_back(d);
  }
  if (steps.empty()) return 0;
  // The least one, and what a few together say: tables round, too.
  constexpr double kFew = 5.5;
  const double least = *std::min_element(steps.begin(), steps.end());
  double sum = 0, multiples = 0;
  for (const double d : steps)
    if (d < kFew * least) sum += d, multiples += std::round(d / least);
  const double step = sum / multiples;
  const bool all = std::all_of(steps.begin(), steps.end(), [&](double d) {
    const double multiple = d / step;
    return multiple > kFar || std::abs(multiple - std::round(multiple)) < kMultiple;
  });
  return all ? step : 0;
}

// Median of sizes known to `step`: those that are equal are taken as spread over it.
double median_of_sizes(const std::vector<double>& sizes, double step) {
  const double middle = upper_median(sizes);
  if (step == 0 || step < 0.05 * middle) return middle;
  const double low = std::max(0.0, middle - step / 2), high = middle + step / 2;
  double below = 0, within = 0;
  for (const double s : sizes) {
    below += s < low ? 1 : 0;
    within += s >= low && s < high ? 1 : 0;
  }
  return low + (high - low) * (0.5 * static_cast<double>(sizes.size()) - below) / within;
}

// Sizes of the differences of neighbours, `third` or second ones, of all presses.
std::vector<double> differences_of(const Component& component, bool third) {
  std::vector<double> sizes;
  for (const PressForces& press : component.presses) {
    const Series& v = component.of(press);
    for (std::size_t i = third ? 3 : 2; i < v.size(); ++i)
      sizes.push_back(std::abs(third ? v[i] - 3 * v[i - 1] + 3 * v[i - 2] - v[i - 3]
                                     : v[i - 2] - 2 * v[i - 1] + v[i]));
  }
  return sizes;
}

// Distances of the samples in the air from their median in the press.
std::vector<double> scatter_of(const Component& component) {
  std::vector<double> sizes;
  for (const PressForces& press : component.presses) {
    if (press.air.size() < kFewestInAir) continue;
    Series some;
    for (const std::size_t i : press.air) some.push_back(component.of(press)[i]);
    const double rest = median(some);
    for (const double x : some) sizes.push_back(std::abs(x - rest));
  }
  return sizes;
}

// Root mean square over the measured components of the steps to which forces are rounded; 0: those
// of none are, or so finely that hardly a force stays the same while the tool moves.
double step_while_moving(const Recording& recording) {
  constexpr double kStays = 0.05;
  constexpr std::size_t kFewest = 50;
  if (recording.f.empty() || recording.u.empty()) return 0;
  bool one_line = false;
  const std::vector<PressForces> all = forces_of(recording, one_line);
  const std::vector<Press> presses = recording.presses();
  const double peak = peak_of(recording);
  const std::size_t axes = all.front().series.size();
  double squares = 0;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const Component component{all, axis};
    std::size_t moves = 0, stays = 0;
    for (std::size_t p = 0; p < all.size(); ++p) {
      const Series& v = component.of(all[p]);
      for (std::size_t i = 1; i < v.size(); ++i) {
        if (recording.u[presses[p].rows[i]] == recording.u[presses[p].rows[i - 1]]) continue;
        ++moves;
        stays += v[i] == v[i - 1] ? 1 : 0;
      }
    }
    if (moves >= kFewest && static_cast<double>(stays) > kStays * static_cast<double>(moves))
      squares += std::pow(step_of(component, peak), 2);
  }
  return std::sqrt(squares / static_cast<double>(axes));
}

// With the step of `step` where that is most of it.
Noise told_by_steps(Noise noise, double step) {
  constexpr double kMost = 0.5;
  if (step / std::sqrt(12.0) > kMost * noise.value) noise.step = step;
  return noise;
}

}  // namespace

NoiseEstimate measure_force_noise(const Recording& recording) {
  NoiseEstimate estimate;
  if (recording.f.empty()) return estimate;
  bool one_line = false;
  const std::vector<PressForces> presses = forces_of(recording, one_line);
  const double peak = peak_of(recording);
  std::size_t used = 0, few_rows = 0, with_air = 0;
  for (const PressForces& press : presses) {
    const std::size_t n = press.series.front().size();
    used += n >= 3 ? 1 : 0;
    few_rows += n > 3 && n < kLong ? 1 : 0;
    with_air += press.air.size() >= kFewestInAir ? 1 : 0;
  }
  const bool third = 2 * few_rows > used;

  // Sums over the components of their variances.
  const std::size_t axes = presses.front().series.size();
  double by_differences = 0, by_air = 0, samples_in_air = 0;
  bool rounded = false;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const Component component{presses, axis};
    const std::vector<double> differences = differences_of(component, third);
    if (differences.empty()) return estimate;
    estimate.differences = differences.size();
    const double step = step_of(component, peak), rounding = step / std::sqrt(12.0);
    const double sigma =
        median_of_sizes(differences, step) / (kNormalMedian * std::sqrt(third ? 20.0 : 6.0));
    rounded = rounded || sigma < rounding;
    by_differences += std::pow(std::max(sigma, rounding), 2);
    const std::vector<double> scatter = scatter_of(component);
    samples_in_air += static_cast<double>(scatter.size());
    by_air += std::pow(median_of_sizes(scatter, step) / kNormalMedian, 2);
  }
  const auto mean = [axes](double sum) { return std::sqrt(sum / static_cast<double>(axes)); };
  estimate.along = mean(by_differences);
  estimate.how = fmt::format("{} differences of {}{}", third ? "third" : "second",
                             counted(used, "press", "presses"),
                             rounded ? " and the step to which it is rounded" : "");
  if (mean(by_air) > estimate.along * (1 + kChance / std::sqrt(samples_in_air))) {
    estimate.along = mean(by_air);
    estimate.how = "the samples in the air of " + counted(with_air, "press", "presses");
  }
  estimate.sigma = estimate.along / (one_line ? std::sqrt(measured_axes(recording.f)) : 1);
  if (estimate.sigma < kNothing * peak) {
    estimate.sigma = estimate.along = kLeast * peak;
    estimate.how = "the largest force: there is next to none";
  }
  return estimate;
}

std::optional<Noise> declared_noise(const Recording& recording) {
  constexpr double kCounts = 0.25;
  const std::optional<double> declared = recording.force_noise();
  if (!declared) return {};
  if (const auto how = recording.metadata.find("force_noise_from"))
    return told_by_steps({*declared, false, "estimated from " + *how},
                         step_while_moving(recording));
  Noise noise{*declared, false, "declared"};
  const double step = step_while_moving(recording), rounding = step / std::sqrt(12.0);
  if (rounding > kCounts * noise.value) {
    noise.value = std::hypot(noise.value, rounding);
    noise.origin += fmt::format(", with the steps of {:.3g} N to which forces are rounded", step);
  }
  return told_by_steps(noise, step);
}

void forget_force_noise(Metadata& metadata) {
  for (const char* key : {"force_noise", "force_noise_from"}) metadata.remove(key);
}

Noise force_noise(const Recording& recording) {
  if (const auto declared = declared_noise(recording)) return *declared;
  const double measured = measure_force_noise(recording).sigma;
  return told_by_steps(
      {measured > 0 ? measured : kLeast * peak_of(recording), true, "measured from the data"},
      step_while_moving(recording));
}

}  // namespace hapsim
