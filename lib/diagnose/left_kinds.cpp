#include "diagnose/left_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/breakdown.h"
#include "diagnose/gates.h"
#include "diagnose/kind_laws.h"
#include "diagnose/left_over.h"
#include "diagnose/unseen_share.h"

namespace hapsim {
namespace {

constexpr double kTold = 0.1;            // of what is left, to be worth a word
constexpr double kRidge = 1e-4;          // of laws that all presses share
constexpr double kRidgeOfPlaces = 1e-2;  // of gains of a place, which few presses tell
constexpr double kHalf = 0.5, kNearlyAll = 0.9;
constexpr double kSameShare = 0.02;  // shares that are alike

Eigen::MatrixXd gains_of_all(const LawSamples& s) {
  Eigen::MatrixXd X(s.f.size(), 2);
  X << s.along.reshaped(), s.across.reshaped();
  return X;
}

double unforetold_by_places(const LawSamples& s, const Eigen::VectorXd& residual,
                            const Eigen::VectorXd& forces, const std::vector<int>& parts,
                            const Dataset& dataset) {
  std::map<Eigen::Index, std::size_t> kept;  // of a sample of all: which of those kept
  for (std::size_t k = 0; k < s.kept.size(); ++k) kept[s.kept[k]] = k;
  double left = 0;
  for (const GainBlock& place : gain_directions(dataset, all_episodes(dataset), forces)) {
    std::vector<Eigen::Index> of_block, rows;
    std::vector<int> own;
    for (std::size_t i = 0; i < place.rows.size(); ++i) {
      const auto found = kept.find(place.rows[i] / 3);
      if (found == kept.end()) continue;
      of_block.push_back(static_cast<Eigen::Index>(i));
      rows.push_back(3 * static_cast<Eigen::Index>(found->second) + place.rows[i] % 3);
      if (place.rows[i] % 3 == 0) own.push_back(parts[found->second]);
    }
    left += unforetold_squares(place.Z(of_block, Eigen::all), residual(rows), own, kRidgeOfPlaces);
  }
  return left;
}

// A gain of each press, told by stretches of it that are left out in turn.
double unforetold_by_presses(const LawSamples& s, const Eigen::VectorXd& residual) {
  constexpr Eigen::Index kStretch = 8;
  double left = 0;
  for (std::size_t from = 0, to = 0; from < s.kept.size(); from = to) {
    std::vector<int> parts;
    for (to = from; to < s.kept.size() && (to == from || s.since[to] > s.since[to - 1]); ++to)
      parts.push_back(static_cast<int>(s.since[to] / kStretch % 3));
    const auto first = static_cast<Eigen::Index>(from),
               count = static_cast<Eigen::Index>(to - from);
    left += unforetold_squares(s.f.middleCols(first, count).reshaped(),
                               residual.segment(3 * first, 3 * count), parts, kRidge);
  }
  return left;
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
      {"cycle", "how often the place was pressed"},
      {"history", "how the force rose and fell before"},
      {"reading", "what each axis of the sensor reads (its converter)"},
      {kSetUp, "axes that are mixed (sensor, robot)"},
      {kDirection, "the direction and the size of the force"},
      {kBody, "the place"},
      {kPress, "a gain of each press (tried on its other samples)"}};
  return words.at(kind);
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

  std::vector<LeftKind> found;
  const double all = r.squaredNorm();
  const auto judge = [&](const std::string& kind, double before, double left) {
    left = std::max(left, noise);
    if (before - left < kTold * beyond) return;
    const double share = (all - left) / beyond;
    const auto known =
        std::find_if(found.begin(), found.end(), [&](const LeftKind& k) { return k.kind == kind; });
    if (known == found.end())
      found.push_back({kind, share});
    else
      known->share = std::max(known->share, share);
  };
  const Eigen::MatrixXd gains = gains_of_all(s);
  const double by_gains = std::min(all, unforetold_squares(gains, r, parts, kRidge));
  for (const KindLaw& law : kind_laws(s, forces, dataset)) {
    Eigen::MatrixXd columns = law.columns();
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 2);
    columns.rightCols(2) = gains;
    judge(law.kind, law.kind == kSetUp ? all : by_gains,
          unforetold_squares(columns, r, parts, kRidge));
  }
  judge(kBody, by_gains, unforetold_by_places(s, r, forces, parts, dataset));
  std::stable_sort(found.begin(), found.end(), [](const LeftKind& a, const LeftKind& b) {
    return std::round(a.share / kSameShare) > std::round(b.share / kSameShare);
  });
  const double by_presses = (all - std::max(noise, unforetold_by_presses(s, r))) / beyond;
  if (by_presses > kNearlyAll && (found.empty() || found.front().share < kHalf))
    found.insert(found.begin(), {kPress, by_presses});
  return found;
}

std::string words_of(const std::vector<LeftKind>& kinds) {
  constexpr std::size_t kMost = 3;
  std::string words;
  for (std::size_t k = 0; k < std::min(kMost, kinds.size()); ++k) {
    if (kinds[k].share < kHalf * kinds.front().share) break;
    words += k == 0 ? fmt::format("{} foretells {:.0f} % of that", goes_with(kinds[k].kind),
                                  100 * kinds[k].share)
                    : fmt::format(", {} {:.0f} %", goes_with(kinds[k].kind), 100 * kinds[k].share);
  }
  return words.empty() ? "" : "Tried on presses that were left out, " + words + ".";
}

}  // namespace hapsim
