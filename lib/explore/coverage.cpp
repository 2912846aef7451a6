#include "explore/coverage.h"

#include <algorithm>
#include <limits>

#include "fit/testable.h"
#include "plan/press_paths.h"

namespace hapsim {
namespace {

constexpr double kHoldSeconds = 1, kStill = 0.05;  // of the deepest displacement
constexpr double kOtherPace = 3;

double depth_of(const PressView& view, std::size_t i) {
  return view.in_air[i] ? 0 : std::max(0.0, -view.u[i].dot(view.normal));
}

double deepest_of(const PressView& view) {
  double deepest = 0;
  for (std::size_t i = 0; i < view.size(); ++i) deepest = std::max(deepest, depth_of(view, i));
  return deepest;
}

bool is_held(const PressView& view) {
  const double still = kStill * deepest_of(view);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (depth_of(view, i) < 2 * still || (view.u[i] - view.u[begin]).norm() > still) begin = i;
    if (view.t[i] - view.t[begin] >= kHoldSeconds) return true;
  }
  return false;
}

// Time of the way in, from a tenth of the depth to nine tenths [s].
double seconds_in(const PressView& view) {
  const double deepest = deepest_of(view);
  double begin = -1;
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (begin < 0 && depth_of(view, i) >= 0.1 * deepest) begin = view.t[i];
    if (depth_of(view, i) >= 0.9 * deepest) return view.t[i] - begin;
  }
  return 0;
}

// Speeds of the way in: where the quickest and the slowest are much alike, the path that has
// another.
void ask_for_another_pace(const Dataset& dataset, std::vector<LackingMotion>& lacking) {
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0, least_time = slowest;
  for (const Episode& e : dataset.episodes) {
    const double seconds = seconds_in(e.view), deepest = deepest_of(e.view);
    if (!(deepest > 0)) continue;
    const double pace = seconds > 0 ? deepest / seconds : std::numeric_limits<double>::infinity();
    slowest = std::min(slowest, pace);
    fastest = std::max(fastest, pace);
    least_time = std::min(least_time, seconds);
  }
  if (fastest >= kOtherPace * slowest && slowest < fastest) return;
  lacking.push_back({"all presses go in at one pace", least_time > 1 ? kHeldTurn : kSlowTurn});
}

}  // namespace

std::vector<LackingMotion> lacking_motions(const Dataset& dataset) {
  const auto some = [&](auto&& condition) {
    return std::any_of(dataset.episodes.begin(), dataset.episodes.end(),
                       [&](const Episode& e) { return condition(e.view); });
  };
  std::vector<LackingMotion> lacking;
  if (!some(moves_sideways)) lacking.push_back({"no press moves sideways", kSidewaysTurn});
  if (!some(comes_back)) lacking.push_back({"no press is recorded on its way out", kSlowTurn});
  if (dataset.recording.t.empty()) return lacking;
  if (!some(is_held)) lacking.push_back({"no press is held for a second", kHeldTurn});
  ask_for_another_pace(dataset, lacking);
  return lacking;
}

std::size_t places_apart(const std::vector<Vec3>& positions, double apart) {
  std::vector<Vec3> kept;
  for (const Vec3& p : positions)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Vec3& k) { return (k - p).norm() < apart; }))
      kept.push_back(p);
  return kept.size();
}

Coverage coverage_of(const Dataset& dataset) {
  return {dataset.episodes.size(), places_apart(dataset.positions, dataset.recording.disc_radius()),
          lacking_motions(dataset)};
}

std::vector<UntestedEffect> untested_effects(const Diagnosis& d) {
  std::vector<UntestedEffect> untested;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kNotTestable) untested.push_back({f.effect, f.evidence});
  return untested;
}

}  // namespace hapsim
