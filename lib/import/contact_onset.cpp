#include "import/contact_onset.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostSamples = 2000;

struct Approach {
  std::vector<double> s, f;
};

// Samples until the force first reaches 60 % of its rise (later cycles do not tell where the first
// contact was), thinned by means of neighbours.
Approach approach_of(const std::vector<double>& travel, const std::vector<double>& force,
                     double start) {
  const double top = *std::max_element(force.begin(), force.end());
  const auto peak = static_cast<std::size_t>(
      std::find_if(force.begin(), force.end(),
                   [&](double f) { return f >= start + 0.6 * (top - start); }) -
      force.begin());
  const std::size_t each = peak / kMostSamples + 1;
  Approach approach;
  for (std::size_t i = 0; i <= peak; i += each) {
    const std::size_t end = std::min(i + each, peak + 1);
    double s = 0, f = 0;
    for (std::size_t k = i; k < end; ++k) {
      s += travel[k];
      f += force[k];
    }
    approach.s.push_back(s / static_cast<double>(end - i));
    approach.f.push_back(f / static_cast<double>(end - i));
  }
  return approach;
}

struct Fit {
  double s0 = 0, b = 0, k = 0;
  double error = std::numeric_limits<double>::infinity();  // sum of squares
};

// Least squares for b (unless fixed at 0) and k at a given contact s0 and power.
Fit fit_at(const Approach& a, double s0, double power, bool free_base) {
  double n = 0, sh = 0, shh = 0, sf = 0, shf = 0, sff = 0;
  for (std::size_t i = 0; i < a.s.size(); ++i) {
    const double h = a.s[i] > s0 ? std::pow(a.s[i] - s0, power) : 0;
    n += 1;
    sh += h;
    shh += h * h;
    sf += a.f[i];
    shf += h * a.f[i];
    sff += a.f[i] * a.f[i];
  }
  Fit fit;
  fit.s0 = s0;
  const double det = free_base ? n * shh - sh * sh : shh;
  if (det <= 1e-12 * n * shh || shh == 0) return fit;
  fit.k = free_base ? (n * shf - sh * sf) / det : shf / shh;
  fit.b = free_base ? (sf - fit.k * sh) / n : 0;
  if (fit.k <= 0) return fit;
  fit.error = std::max(0.0, sff - fit.k * shf - fit.b * sf);
  return fit;
}

Fit best_fit(const Approach& a, double low, double high, double power, bool free_base) {
  constexpr int kGrid = 120;
  Fit best;
  for (int round = 0; round < 3; ++round) {
    const double step = (high - low) / kGrid;
    for (int i = 0; i <= kGrid; ++i) {
      const Fit fit = fit_at(a, low + i * step, power, free_base);
      if (fit.error < best.error) best = fit;
    }
    if (!std::isfinite(best.error)) return best;
    low = std::max(low, best.s0 - step);
    high = std::min(high, best.s0 + step);
  }
  return best;
}

}  // namespace

double difference_noise(const std::vector<double>& v) {
  std::vector<double> differences;
  if (v.size() < 5) return 0;
  const bool third = v.size() < 20;
  for (std::size_t i = 3; i < v.size(); ++i)
    differences.push_back(std::abs(third ? v[i] - 3 * v[i - 1] + 3 * v[i - 2] - v[i - 3]
                                         : v[i] - 2 * v[i - 1] + v[i - 2]));
  return median(differences) / (0.6745 * std::sqrt(third ? 20.0 : 6.0));
}

ContactOnset find_contact_onset(const std::vector<double>& travel,
                                const std::vector<double>& force) {
  ContactOnset onset;
  if (travel.size() < 3) return onset;
  onset.noise = difference_noise(force);
  const auto lead = static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(force.size() / 40, 1, 20));
  const double start = median({force.begin(), force.begin() + lead});
  const double top = *std::max_element(force.begin(), force.end());
  Approach a = approach_of(travel, force, start);
  if (top - start <= std::max(6 * onset.noise, 1e-9 * std::abs(top))) return onset;

  // Window: all of the air, then up to 30 % of the force, at least four samples beyond that start.
  std::size_t end = a.f.size();
  while (end > 0 && a.f[end - 1] > start + 0.3 * (top - start)) --end;
  end = std::min(a.f.size(), std::max<std::size_t>(end + 1, 4));
  a.s.resize(end);
  a.f.resize(end);
  const double low = *std::min_element(a.s.begin(), a.s.end());
  const double high = *std::max_element(a.s.begin(), a.s.end());
  if (high <= low) return onset;

  Fit best;
  const std::vector<double> powers =
      end >= 12 ? std::vector{1.0, 1.25, 1.5, 2.0} : std::vector{1.0};
  for (const double power : powers) {
    const Fit fit = best_fit(a, low, high, power, true);
    if (fit.error < 0.98 * best.error) best = fit;  // a straighter one wins a tie
  }
  const auto in_air = [&] {
    return std::count_if(a.s.begin(), a.s.end(), [&best](double s) { return s <= best.s0; });
  };
  if (!std::isfinite(best.error) || in_air() < 3) {
    best = {};
    for (const double power : powers) {
      const Fit fit = best_fit(a, low - (high - low), high, power, false);
      if (fit.error < 0.98 * best.error) best = fit;
    }
    if (!std::isfinite(best.error)) return onset;
  }
  onset.found = true;
  onset.depth = best.s0;
  onset.baseline = best.b;
  onset.air_samples = static_cast<int>(
      std::find_if(travel.begin(), travel.end(), [&best](double s) { return s >= best.s0; }) -
      travel.begin());
  return onset;
}

}  // namespace hapsim
