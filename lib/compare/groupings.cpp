#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/breakdown.h"

namespace hapsim {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kDepthBins = 6, kTemperatureBins = 4;
constexpr double kSameTemperature = 0.5;  // [K]
constexpr double kSmallestShare = 0.03;   // of the rows, that a bin must hold

double rounded(double value, int digits) {
  if (!(value > 0)) return 0;
  const double unit = std::pow(10, std::floor(std::log10(value)) - (digits - 1));
  return std::round(value / unit) * unit;
}

// The rows that count: pressed ones.
std::vector<double> pressed(const RowFacts& facts, const std::vector<double>& values) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (facts.phase[i] != Phase::kAir) kept.push_back(values[i]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

// Rounded, for the labels; those that leave a bin nearly empty are dropped.
std::vector<double> quantile_bounds(const std::vector<double>& sorted, int bins) {
  std::vector<double> bounds;
  const auto total = static_cast<double>(sorted.size());
  double last = 0;
  for (int b = 1; b < bins && !sorted.empty(); ++b) {
    const double bound = rounded(sorted[sorted.size() * static_cast<std::size_t>(b) / bins], 2);
    const auto below =
        static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), bound) - sorted.begin());
    if (below - last < kSmallestShare * total || total - below < kSmallestShare * total) continue;
    bounds.push_back(bound);
    last = below;
  }
  return bounds;
}

// Bounds of the series 1, 2, 5, 10 that leave no bin nearly empty.
std::vector<double> series_bounds(const std::vector<double>& sorted) {
  std::vector<double> bounds;
  const auto below = [&](double x) {
    return std::lower_bound(sorted.begin(), sorted.end(), x) - sorted.begin();
  };
  const double least = kSmallestShare * static_cast<double>(sorted.size());
  double last = 0;
  const double smallest = sorted.empty() ? 0 : 1e-3 * sorted.back();  // slower than that is rest
  for (int e = -9; e <= 6; ++e)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double bound = digit * std::pow(10, e);
      if (bound < smallest) continue;
      const auto count = static_cast<double>(below(bound));
      if (count - last < least || static_cast<double>(sorted.size()) - count < least) continue;
      bounds.push_back(bound);
      last = count;
    }
  return bounds;
}

struct Wording {
  const char* unit;
  double scale;  // from SI
  const char* first;
  const char* last;
};

Grouping ranged(const char* name, const char* title, const RowFacts& facts,
                const std::vector<double>& values, const std::vector<double>& bounds,
                const Wording& words) {
  Grouping g{name, title, Grouping::Kind::kRows, {}, std::vector<int>(values.size(), -1)};
  const auto shown = [&](double x) {
    return std::abs(x * words.scale) < 1000 ? fmt::format("{:.3g}", x * words.scale)
                                            : fmt::format("{:.0f}", x * words.scale);
  };
  for (std::size_t b = 0; b <= bounds.size(); ++b) {
    const double lower = b == 0 ? 0 : bounds[b - 1];
    const double upper = b == bounds.size() ? kNone : bounds[b];
    std::string label;
    if (bounds.empty())
      label = "all";
    else if (b == 0)
      label = fmt::format("{} {} {}", words.first, shown(upper), words.unit);
    else if (b == bounds.size())
      label = fmt::format("{} {} {}", words.last, shown(lower), words.unit);
    else
      label = fmt::format("{} to {} {}", shown(lower), shown(upper), words.unit);
    g.bins.push_back({label, lower, upper});
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (facts.phase[i] != Phase::kAir)
      g.bin[i] = static_cast<int>(std::upper_bound(bounds.begin(), bounds.end(), values[i]) -
                                  bounds.begin());
  return g;
}

Grouping by_position(const RowFacts& facts) {
  Grouping g{"position", "By position", Grouping::Kind::kRows, {}, facts.position};
  for (const Vec3& p : facts.positions)
    g.bins.push_back(
        {fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * p[0], 1e3 * p[1], 1e3 * p[2]), kNone,
         kNone});
  return g;
}

Grouping by_press_direction(const RowFacts& facts) {
  Grouping g{"press-direction", "By direction of the press", Grouping::Kind::kRows, {}, {}};
  g.bins = {{"in straight presses", kNone, kNone}, {"in sideways presses", kNone, kNone}};
  for (std::size_t i = 0; i < facts.press.size(); ++i)
    g.bin.push_back(facts.phase[i] == Phase::kAir ? -1 : facts.sideways[facts.press[i]]);
  return g;
}

// First presses of a place against later ones.
Grouping by_cycle(const RowFacts& facts) {
  Grouping g{"cycle", "By earlier presses of the place", Grouping::Kind::kRows, {}, {}};
  g.bins = {{"in the first press of a place", kNone, kNone},
            {"where it was pressed before", kNone, kNone}};
  for (std::size_t i = 0; i < facts.press.size(); ++i)
    g.bin.push_back(facts.phase[i] == Phase::kAir ? -1 : facts.repeated[facts.press[i]]);
  return g;
}

// Degrees are no size: bounds are quantiles to a tenth of a degree, whatever the sign.
Grouping by_temperature(const RowFacts& facts) {
  std::vector<double> bounds;
  const std::vector<double> sorted = pressed(facts, facts.temperature);
  for (int b = 1; b < kTemperatureBins; ++b) {
    const double bound =
        0.1 *
        std::round(10 * sorted[sorted.size() * static_cast<std::size_t>(b) / kTemperatureBins]);
    if (bound > sorted.front() && (bounds.empty() || bound > bounds.back()))
      bounds.push_back(bound);
  }
  return ranged(kByTemperature, "By temperature", facts, facts.temperature, bounds,
                {"degC", 1, "below", "above"});
}

Grouping by_phase(const RowFacts& facts) {
  Grouping g{"phase", "By phase", Grouping::Kind::kRows, {}, {}};
  for (const char* label : {"while loading", "while held", "while unloading", "not pressed"})
    g.bins.push_back({label, kNone, kNone});
  for (const Phase phase : facts.phase) g.bin.push_back(static_cast<int>(phase));
  return g;
}

// Five spans of the session with about equally many presses.
Grouping by_session(const RowFacts& facts) {
  const std::vector<double> sorted = pressed(facts, facts.session);
  const double start =
      facts.session.empty() ? 0 : *std::min_element(facts.session.begin(), facts.session.end());
  std::vector<double> since(facts.session), bounds;
  for (double& t : since) t -= start;
  std::vector<double> shifted(sorted);
  for (double& t : shifted) t -= start;
  bounds = quantile_bounds(shifted, 5);
  return ranged("session-time", "By time in the session", facts, since, bounds,
                {"s", 1, "before", "after"});
}

}  // namespace

std::vector<Grouping> make_groupings(const RowFacts& facts) {
  std::vector<Grouping> result;
  result.push_back(by_position(facts));
  result.push_back(ranged("depth", "By depth", facts, facts.depth,
                          quantile_bounds(pressed(facts, facts.depth), kDepthBins),
                          {"mm", 1e3, "below", "above"}));
  if (!facts.rate.empty()) {
    result.push_back(ranged("rate", "By speed of the tool", facts, facts.rate,
                            series_bounds(pressed(facts, facts.rate)),
                            {"mm/s", 1e3, "below", "above"}));
    result.push_back(ranged("contact-time", "By time since contact", facts, facts.contact_age,
                            series_bounds(pressed(facts, facts.contact_age)),
                            {"s", 1, "in the first", "later than"}));
    result.push_back(by_session(facts));
  }
  Grouping direction{"direction", "By direction of the force", Grouping::Kind::kComponents, {}, {}};
  direction.bins = {{"along the normal", kNone, kNone}, {"sideways", kNone, kNone}};
  result.push_back(direction);
  if (std::find(facts.sideways.begin(), facts.sideways.end(), 1) != facts.sideways.end())
    result.push_back(by_press_direction(facts));
  if (std::find(facts.repeated.begin(), facts.repeated.end(), 1) != facts.repeated.end())
    result.push_back(by_cycle(facts));
  const std::vector<double> temperatures = pressed(facts, facts.temperature);
  if (!temperatures.empty() && temperatures.back() - temperatures.front() > kSameTemperature)
    result.push_back(by_temperature(facts));
  result.push_back(by_phase(facts));
  return result;
}

}  // namespace hapsim
