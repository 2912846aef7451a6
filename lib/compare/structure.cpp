#include "compare/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "compare/gain_sentences.h"
#include "compare/idle_force.h"
#include "estimate/probability.h"

namespace hapsim {
namespace {

constexpr double kFamilyLevel = 0.02;     // chance of any sentence on pure noise
constexpr double kLeastExplained = 0.01;  // of the squared error, to be worth a sentence
constexpr double kSmallestGain = 0.003;   // a relative force error below this is nobody's worry

// One thing that may be wrong: its size, its chance, and the simulated force without it.
struct Hypothesis {
  Observation finding;
  double explained = 0;         // squared error it takes off, less what chance takes [N^2]
  std::vector<Vec3> corrected;  // filled only for the one that is told
};

struct Search {
  const RowFacts& facts;
  const std::vector<Vec3>& measured;
  std::vector<Vec3> simulated;  // with all that has been told taken off
  double noise;
  bool first = true;  // nothing has been told yet
};

double squared_error(const std::vector<Vec3>& m, const std::vector<Vec3>& s) {
  double sum = 0;
  for (std::size_t i = 0; i < m.size(); ++i) sum += (m[i] - s[i]).squaredNorm();
  return sum;
}

// What noise alone leaves of the measured components [N^2].
double by_noise(const Search& search) {
  return measured_axes(search.measured) * search.noise * search.noise *
         static_cast<double>(search.measured.size());
}

// P-value of a gain that differs from 1; bins of fewer than three presses cannot be judged when the
// recording has more.
double gain_p_value(const BinError& e, std::size_t presses) {
  if (!(e.gain_error > 0) || std::abs(e.gain - 1) < kSmallestGain) return 1;
  const double z = (e.gain - 1) / e.gain_error;
  if (presses < 3) return student_two_sided(z, 1e9);
  return e.presses < 3 || e.freedom < 1 ? 1 : student_two_sided(z, e.freedom);
}

double explained_by_gains(const std::vector<BinError>& errors, double noise) {
  double sum = 0;
  for (const BinError& e : errors)
    if (e.weight > 0) sum += e.weight * (e.gain - 1) * (e.gain - 1) - noise * noise;
  return sum;
}

// A bin for each press.
Grouping by_press(const Search& search) {
  Grouping presses;
  presses.bins.resize(search.facts.press_ids.size());
  presses.bin = search.facts.press;
  return presses;
}

// Gains of positions: scatter between positions over scatter between presses of one position, the
// latter at least the noise's.
double position_p_value(const Search& search, const std::vector<BinError>& positions) {
  const auto presses =
      bin_errors(by_press(search), search.facts, search.measured, search.simulated, search.noise);
  std::vector<int> position(presses.size(), 0);
  for (std::size_t i = 0; i < search.facts.press.size(); ++i)
    position[search.facts.press[i]] = search.facts.position[i];

  double weight = 0, mean = 0, between = 0, within = 0;
  for (const BinError& e : positions)
    if (e.weight > 0) weight += e.weight, mean += e.weight * e.gain;
  if (!(weight > 0)) return 1;
  mean /= weight;
  double groups = 0, count = 0;
  for (const BinError& e : positions)
    if (e.weight > 0) between += e.weight * (e.gain - mean) * (e.gain - mean), ++groups;
  for (std::size_t c = 0; c < presses.size(); ++c)
    if (presses[c].weight > 0) {
      const double off = presses[c].gain - positions[position[c]].gain;
      within += presses[c].weight * off * off, ++count;
    }
  if (groups < 2) return 1;
  const double variance = search.noise * search.noise;
  const double freedom = count - groups;
  if (freedom < 3) return fisher_upper(between / (groups - 1) / variance, groups - 1, 1e6);
  return fisher_upper(between / (groups - 1) / std::max(within / freedom, variance), groups - 1,
                      freedom);
}

std::vector<Vec3> scaled(const Search& search, const Grouping& grouping,
                         const std::vector<BinError>& errors) {
  std::vector<Vec3> result(search.simulated);
  for (std::size_t i = 0; i < result.size(); ++i)
    for_each_part(grouping, search.facts, i, search.measured[i], search.simulated[i],
                  [&](int bin, const Vec3&, const Vec3& s, int) {
                    if (errors[bin].weight > 0) result[i] += (errors[bin].gain - 1) * s;
                  });
  return result;
}

// One gain for everything; with it the others tell what differs from it.
Grouping everything(const RowFacts& facts) {
  Grouping all;
  all.name = "overall";
  all.bins.resize(1);
  all.bin.assign(facts.press.size(), 0);
  return all;
}

Hypothesis try_grouping(const Search& search, const Grouping& grouping) {
  Hypothesis h;
  h.finding.kind = grouping.name;
  const auto errors =
      bin_errors(grouping, search.facts, search.measured, search.simulated, search.noise);
  h.explained = explained_by_gains(errors, search.noise);
  const std::size_t presses = search.facts.press_ids.size();
  if (grouping.name == "overall") {
    h.finding.p_value = gain_p_value(errors[0], presses);
    h.finding.sentence = sentence_overall(errors[0]);
    return h;
  }
  // A common gain is told by itself: what counts here is how the bins differ from it.
  const Grouping all = everything(search.facts);
  const auto common =
      bin_errors(all, search.facts, search.measured, search.simulated, search.noise);
  const auto rest = bin_errors(grouping, search.facts, search.measured, scaled(search, all, common),
                               search.noise);
  if (explained_by_gains(rest, search.noise) < 0.1 * h.explained) h.explained = 0;
  if (grouping.name == "position") {
    h.finding.p_value = position_p_value(search, errors);
  } else {
    int tried = 0;
    double smallest = 1;
    for (const BinError& e : rest) {
      if (!(e.weight > 0)) continue;
      ++tried;
      smallest = std::min(smallest, gain_p_value(e, presses));
    }
    h.finding.p_value = std::min(1.0, smallest * tried);
  }
  h.finding.sentence = sentence_of_bins(grouping, errors);
  return h;
}

// What is left where it goes with nothing but the press: a gain of each takes most of it away.
Observation gains_of_presses(const Search& search, double square) {
  constexpr double kMost = 0.5;
  Grouping grouping = by_press(search);
  const auto errors =
      bin_errors(grouping, search.facts, search.measured, search.simulated, search.noise);
  const double rest = squared_error(search.measured, scaled(search, grouping, errors));
  const double beyond = square - by_noise(search);
  Observation found;
  if (errors.size() < 3 || square - rest < kMost * beyond) return found;
  double least = 1, most = 1;
  for (const BinError& e : errors)
    if (e.weight > 0) least = std::min(least, e.gain), most = std::max(most, e.gain);
  found.kind = "press";
  found.p_value = 0;  // of many samples a press, none alike by chance
  found.sentence = fmt::format(
      "The error changes from press to press: forces are {:.2g} to {:.2g} times the model's, which "
      "takes {:.0f} % of what is left away and goes with no place, direction, depth or order: look "
      "at what changes between presses, the grip, the temperature, the body itself.",
      least, most, 100 * std::min(1.0, (square - rest) / beyond));
  return found;
}

// What nothing explains: larger than noise, and neighbouring samples of a press err alike.
Observation what_is_left(const Search& search, double total) {
  // Well beyond what an estimate of the noise errs by; and a correlation that white noise of 100
  // samples has once in 20 (two standard errors of 1/10).
  constexpr double kBeyondNoise = 1.5, kAlike = 0.2;
  double square = 0, product = 0;
  for (std::size_t i = 0; i < search.measured.size(); ++i) {
    const Vec3 r = search.measured[i] - search.simulated[i];
    square += r.squaredNorm();
    if (i > 0 && search.facts.press[i] == search.facts.press[i - 1])
      product += r.dot(search.measured[i - 1] - search.simulated[i - 1]);
  }
  const auto rows = static_cast<double>(search.measured.size());
  const double left = std::sqrt(square / (measured_axes(search.measured) * rows));
  Observation rest;
  if (search.noise <= 0 || left < kBeyondNoise * search.noise || product < kAlike * square ||
      square < kLeastExplained * total)
    return rest;
  if (Observation gains = gains_of_presses(search, square); !gains.sentence.empty()) {
    gains.share = square / total;
    return gains;
  }
  rest.kind = "left";
  rest.p_value = 0;  // of many samples, none alike by chance
  rest.share = square / total;
  rest.sentence = fmt::format(
      "{:.2g} N, {:.2g} times the noise, is left that goes with nothing that was looked at, and is "
      "no noise: neighbouring samples err alike (correlation {:.2f}).",
      left, left / search.noise, product / square);
  return rest;
}

}  // namespace

std::vector<Observation> find_structure(const RowFacts& facts, const std::vector<Vec3>& measured,
                                        const std::vector<Vec3>& simulated, double noise,
                                        std::size_t most) {
  Search search{facts, measured, simulated, noise};
  std::vector<Grouping> groupings = make_groupings(facts);
  groupings.insert(groupings.begin(), everything(facts));
  const double total = squared_error(measured, simulated);
  const double beyond = total - by_noise(search);
  std::vector<Observation> found;
  while (found.size() < most) {
    Hypothesis best;
    std::size_t which = 0;
    const auto offsets = try_offsets(facts, measured, search.simulated, noise);
    const double tried = static_cast<double>(groupings.size() + offsets.size());
    const auto consider = [&](Hypothesis h, std::size_t index) {
      h.finding.p_value = std::min(1.0, h.finding.p_value * tried);
      if (h.finding.p_value >= kFamilyLevel || h.finding.sentence.empty()) return;
      if (h.explained <= best.explained || h.explained < kLeastExplained * total) return;
      best = std::move(h);
      which = index;
    };
    for (std::size_t g = 0; g < groupings.size(); ++g)
      consider(try_grouping(search, groupings[g]), g);
    for (std::size_t o = 0; o < offsets.size(); ++o)
      consider(
          {{offsets[o].name, offsets[o].sentence, offsets[o].p_value, 0}, offsets[o].explained, {}},
          groupings.size() + o);
    if (best.finding.sentence.empty()) break;
    best.finding.share = std::min(1.0, best.explained / std::max(beyond, 1e-300));
    if (which < groupings.size())
      search.simulated =
          scaled(search, groupings[which],
                 bin_errors(groupings[which], facts, measured, search.simulated, noise));
    else
      search.simulated = offsets[which - groupings.size()].corrected;
    found.push_back(best.finding);
    if (found.size() > 1)
      found.back().sentence = "Beyond that, t" + found.back().sentence.substr(1);
  }
  if (const Observation rest = what_is_left(search, total); !rest.sentence.empty())
    found.push_back(rest);
  return found;
}

}  // namespace hapsim
