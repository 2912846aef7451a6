#include "diagnose/left_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/breakdown.h"
#include "diagnose/gates.h"
#include "diagnose/kind_laws.h"
#include "diagnose/left_over.h"
#include "diagnose/own_laws.h"
#include "diagnose/unseen_share.h"

namespace hapsim {
namespace {

constexpr double kTold = 0.1;  // of what is left, to be worth a word
constexpr double kHalf = 0.5, kAsMuch = 0.8;
constexpr Eigen::Index kGainsOfPlace = 6;

// Of each sample, as of unforetold_squares().
Eigen::VectorXd unforetold_by_places(const LawSamples& s, const Eigen::VectorXd& residual,
                                     const Eigen::VectorXd& forces, const std::vector<int>& parts,
                                     const Dataset& dataset) {
  std::map<Eigen::Index, std::size_t> kept;  // of a sample of all: which of those kept
  for (std::size_t k = 0; k < s.kept.size(); ++k) kept[s.kept[k]] = k;
  Eigen::VectorXd left = Eigen::VectorXd::Zero(s.f.cols());
  for (const GainBlock& place : gain_directions(dataset, all_episodes(dataset), forces)) {
    std::vector<Eigen::Index> of_block, rows, samples;
    std::vector<int> own;
    for (std::size_t i = 0; i < place.rows.size(); ++i) {
      const auto found = kept.find(place.rows[i] / 3);
      if (found == kept.end()) continue;
      of_block.push_back(static_cast<Eigen::Index>(i));
      rows.push_back(3 * static_cast<Eigen::Index>(found->second) + place.rows[i] % 3);
      if (place.rows[i] % 3 != 0) continue;
      own.push_back(parts[found->second]);
      samples.push_back(static_cast<Eigen::Index>(found->second));
    }
    left(samples) = unforetold_squares(place.Z(of_block, Eigen::all), residual(rows), own);
  }
  return left;
}

struct TriedKind {
  std::string kind;
  Eigen::VectorXd by_press;  // squares left of each press [N^2]
  double left = 0;           // of all, the noise at least
  Eigen::Index numbers = 0;
};

Eigen::VectorXd by_press(const Eigen::VectorXd& samples, const LawSamples& s) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(s.press.back() + 1);
  for (std::size_t k = 0; k < s.press.size(); ++k)
    sum[s.press[k]] += samples[static_cast<Eigen::Index>(k)];
  return sum;
}

// Whether what presses say of two laws may be chance: their mean difference, over its own error.
bool no_worse(const TriedKind& law, const TriedKind& best) {
  constexpr double kPlainly = 2;
  const Eigen::VectorXd more = law.by_press - best.by_press;
  const auto n = static_cast<double>(more.size());
  const double spread = std::sqrt((more.array() - more.mean()).square().sum() / (n - 1) / n);
  return more.mean() <= kPlainly * spread;
}

}  // namespace

std::vector<LeftKind> kinds_of(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                               const TrialGround& g) {
  const Dataset& dataset = g.dataset;
  if (dataset.episodes.size() < kLeastPresses) return {};
  const LawSamples s = law_samples(forces, dataset);
  const Eigen::VectorXd r = residual(stacked_components(s));
  const std::vector<int> every = press_parts(dataset);
  std::vector<int> parts;
  for (const Eigen::Index sample : s.kept) parts.push_back(every[static_cast<std::size_t>(sample)]);
  const double noise =
      g.allowance.noise * g.allowance.noise * dataset.axes() / 3.0 * static_cast<double>(r.size());
  const double beyond = r.squaredNorm() - noise;
  if (!(beyond > 0)) return {};

  const double all = r.squaredNorm();
  std::vector<TriedKind> found;
  const auto judge = [&](const std::string& kind, double before, const Eigen::VectorXd& samples,
                         Eigen::Index numbers) {
    TriedKind now{kind, by_press(samples, s), std::max(samples.sum(), noise), numbers};
    if (before - now.left >= kTold * beyond) found.push_back(std::move(now));
  };
  const Eigen::MatrixXd gains = gain_columns(s);
  const double by_gains = std::min(all, unforetold_squares(gains, r, parts).sum());
  const auto beside_gains = [&](const Eigen::MatrixXd& columns) {
    Eigen::MatrixXd both(r.size(), columns.cols() + gains.cols());
    both << columns, gains;
    return unforetold_squares(both, r, parts);
  };
  judge(kDirection, all, unforetold_squares(gains, r, parts), gains.cols());
  for (const KindLaw& law : kind_laws(s, forces, dataset)) {
    const Eigen::MatrixXd columns = law.columns();
    const Eigen::VectorXd left = beside_gains(columns);
    // What is of another kind foretells no more than half of what it does.
    if (law.without &&
        all - beside_gains(law.without()).sum() > kHalf * (all - std::max(noise, left.sum())))
      continue;
    judge(law.kind, law.kind == kSetUp ? all : by_gains, left, columns.cols() + gains.cols());
  }
  judge(kBody, by_gains, unforetold_by_places(s, r, forces, parts, dataset),
        kGainsOfPlace * static_cast<Eigen::Index>(dataset.positions.size()));
  const auto share = [&](double left) { return (all - left) / beyond; };
  const auto by_error = [](const TriedKind& a, const TriedKind& b) { return a.left < b.left; };
  const auto by_numbers = [](const TriedKind& a, const TriedKind& b) {
    return a.numbers < b.numbers;
  };
  std::stable_sort(found.begin(), found.end(), by_error);
  const TriedKind best = found.empty() ? TriedKind{} : found.front();
  const auto nearly = [&](double part) {
    return [&, part](const TriedKind& each) {
      return share(each.left) > part * share(best.left) && no_worse(each, best);
    };
  };
  const auto alike = std::stable_partition(found.begin(), found.end(), nearly(kHalf));
  std::stable_sort(found.begin(), std::stable_partition(found.begin(), alike, nearly(kAsMuch)),
                   by_numbers);
  std::vector<LeftKind> kinds;
  for (auto each = found.begin(); each != found.end(); ++each) {
    const auto said = [&](const LeftKind& kind) { return kind.kind == each->kind; };
    if (std::none_of(kinds.begin(), kinds.end(), said))
      kinds.push_back({each->kind, share(each->left), each < alike});
  }
  if (!kinds.empty() && kinds.front().share >= kHalf) return kinds;
  const auto beyond_noise = [&](double left) { return share(std::max(noise, left)); };
  std::vector<LeftKind> own = own_laws(s, r, beyond_noise);
  if (own.empty() && kinds.empty()) own = wandering(s, r, beyond_noise);
  if (!own.empty())
    for (LeftKind& kind : kinds) kind.alike = false;
  kinds.insert(kinds.begin(), own.begin(), own.end());
  return kinds;
}

const char* goes_with(const std::string& kind) {
  static const std::map<std::string, const char*> words{
      {"offset", "a zero"},
      {"drift", "a zero that changes in the session"},
      {"depth", "the depth"},
      {"contact-time", "the time since the press began"},
      {"rate", "the speed"},
      {"phase", "loading, hold and unloading"},
      {"session-time", "the time of the session"},
      {kByTemperature, "the temperature"},
      {"cycle", "what was pressed before, how often or how long ago"},
      {"history", "how the force rose and fell before"},
      {"reading", "what each axis of the sensor reads (its converter)"},
      {kSetUp, "axes that are mixed (sensor, robot)"},
      {kDirection, "the direction and the size of the force"},
      {kBody, "the place"},
      {kPress, "gains of each press (tried on its other samples)"},
      {kZeroOfPress, "a zero of each press (tried on its other samples)"},
      {kPlaceAndWay, "the place and the way it is pressed, together (tried on each press)"},
      {kWander, "a force that moves in each press in its own way (tried on its other samples)"}};
  return words.at(kind);
}

std::string words_of(const std::vector<LeftKind>& kinds) {
  constexpr std::size_t kMost = 3;
  std::string words;
  for (std::size_t k = 0; k < std::min(kMost, kinds.size()); ++k) {
    const LeftKind& kind = kinds[k];
    if (kind.share < kHalf * kinds.front().share) break;
    words += k == 0 ? fmt::format("{} foretells {:.0f} % of that", goes_with(kind.kind),
                                  100 * kind.share)
                    : fmt::format(", {} {:.0f} %{}", goes_with(kind.kind), 100 * kind.share,
                                  kind.alike ? " (presses do not tell them apart)" : "");
  }
  return words.empty() ? "" : "Tried on presses that were left out, " + words + ".";
}

}  // namespace hapsim
