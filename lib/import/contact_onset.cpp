#include "import/contact_onset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostSamples = 2000;  // of an approach; denser ones are thinned
constexpr double kMostPower = 2;  // force over depth: 1 a punch, 1.5 a ball (Hertz), 2 a cone
// Shares of the force's rise up to which the law of the contact is fitted: the first window, the
// last.
constexpr double kWindow = 0.3, kLeastWindow = 1.0 / 128;
constexpr double kLeastRise = 30;  // of the noise: no window is smaller
// Of the scatter: a straight rise has 4.3, a whole wave at most some 1.5.
constexpr double kRise = 3;
constexpr double kNegligible = 0.003;  // of the window's force: what no noise asks for
constexpr double kMisfit = 2;          // times noise and waves
constexpr std::size_t kFewestInAir = 8;

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

// All of the air, then up to a force, at least four samples. Empty: the tool does not move in it.
Approach window_of(const Approach& whole, double most) {
  std::size_t end = whole.f.size();
  while (end > 0 && whole.f[end - 1] > most) --end;
  const auto length =
      static_cast<std::ptrdiff_t>(std::min(whole.f.size(), std::max<std::size_t>(end + 1, 4)));
  Approach a{{whole.s.begin(), whole.s.begin() + length},
             {whole.f.begin(), whole.f.begin() + length}};
  const auto [low, high] = std::minmax_element(a.s.begin(), a.s.end());
  return *high > *low ? a : Approach{};
}

// Where contact may have been at the earliest, before the first sample: a power up to kMostPower
// with the force and the slope of the beginning.
double earliest(const Approach& a, double noise) {
  const std::size_t n = std::max<std::size_t>(4, a.s.size() / 5);
  double s = 0, f = 0, ss = 0, sf = 0;
  for (std::size_t i = 0; i < n; ++i) s += a.s[i] / n, f += a.f[i] / n;
  for (std::size_t i = 0; i < n; ++i) {
    ss += (a.s[i] - s) * (a.s[i] - s);
    sf += (a.s[i] - s) * (a.f[i] - f);
  }
  const double low = *std::min_element(a.s.begin(), a.s.end());
  const double high = *std::max_element(a.s.begin(), a.s.end());
  if (!(sf > 0)) return low - (high - low);
  const double first = std::max(0.0, f - sf / ss * (s - low)) + 2 * noise;
  return std::max(low - (high - low), low - kMostPower * first * ss / sf);
}

// Of all powers the best; extrapolated where there is no air.
Fit onset_in(const Approach& a, double noise) {
  const double low = *std::min_element(a.s.begin(), a.s.end());
  const double high = *std::max_element(a.s.begin(), a.s.end());
  const std::vector<double> powers =
      a.s.size() >= 12 ? std::vector{1.0, 1.25, 1.5, kMostPower} : std::vector{1.0};
  const auto best_of = [&](double from, bool free_base) {
    Fit best;
    for (const double power : powers) {
      const Fit fit = best_fit(a, from, high, power, free_base);
      if (fit.error < 0.98 * best.error) best = fit;  // a straighter one wins a tie
    }
    return best;
  };
  const Fit fit = best_of(low, true);
  const auto in_air =
      std::count_if(a.s.begin(), a.s.end(), [&fit](double s) { return s <= fit.s0; });
  return std::isfinite(fit.error) && in_air >= 3 ? fit : best_of(earliest(a, noise), false);
}

double rms_about(const std::vector<double>& values, std::size_t count, double level) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += (values[i] - level) * (values[i] - level);
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

// Whether the window is too large for one power: what is taken for air already feels the body (its
// last quarter is above its first half by more than that half scatters, which waves of the base
// line are not), or the law misses the rows by more than noise and waves.
bool is_too_wide(const Approach& a, const Fit& fit, double noise) {
  std::vector<double> air;
  for (std::size_t i = 0; i < a.s.size() && a.s[i] <= fit.s0; ++i) air.push_back(a.f[i]);
  noise = std::max(noise, kNegligible * (*std::max_element(a.f.begin(), a.f.end()) - fit.b));
  double waves = noise;
  if (air.size() >= kFewestInAir) {
    const auto mean = [&air](std::size_t from, std::size_t to) {
      return std::accumulate(air.begin() + static_cast<std::ptrdiff_t>(from),
                             air.begin() + static_cast<std::ptrdiff_t>(to), 0.0) /
             static_cast<double>(to - from);
    };
    const std::size_t n = air.size();
    const double level = mean(0, n / 2);
    const double scatter = std::max(rms_about(air, n / 2, level), noise);
    if (mean(n - n / 4, n) - level > kRise * scatter) return true;
    waves = std::max(noise, rms_about(air, n, fit.b));
  }
  return std::sqrt(fit.error / static_cast<double>(a.s.size())) > kMisfit * waves;
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
  const Approach approach = approach_of(travel, force, start);
  if (top - start <= std::max(6 * onset.noise, 1e-9 * std::abs(top))) return onset;

  Fit best;
  for (double share = kWindow;; share /= 2) {
    const Approach a = window_of(approach, start + share * (top - start));
    if (a.s.empty()) return onset;
    const Fit fit = onset_in(a, onset.noise);
    if (!std::isfinite(fit.error)) break;
    best = fit;
    if (!is_too_wide(a, best, onset.noise) || share < kLeastWindow ||
        share * (top - start) < kLeastRise * onset.noise)
      break;
  }
  if (!std::isfinite(best.error)) return onset;
  onset.found = true;
  onset.depth = best.s0;
  onset.baseline = best.b;
  onset.air_samples = static_cast<int>(
      std::find_if(travel.begin(), travel.end(), [&best](double s) { return s >= best.s0; }) -
      travel.begin());
  return onset;
}

}  // namespace hapsim
