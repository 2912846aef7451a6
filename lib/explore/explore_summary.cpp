#include "explore/explore_summary.h"

#include <fmt/format.h>

#include <cmath>

#include "base/counted.h"
#include "base/shell_words.h"

namespace hapsim {
namespace {

std::string bare_words(const GoalState& g) {
  if (g.name == "verdict") return g.said + (g.reached ? "; settled" : "; not settled");
  if (g.name == "lump") {
    if (!std::isfinite(g.value)) return "none is seen so far";
    return fmt::format("seen, its centre within ± {:.1f} mm (wanted {:.1f})", 1e3 * g.value,
                       1e3 * g.wanted);
  }
  if (g.name == "unseen") {
    if (!std::isfinite(g.value)) return "not told: no place could be left out";
    if (g.said == "of force")
      return fmt::format(
          "places that were left out are foretold to {:.2g} % of the force (wanted {:.2g})",
          100 * g.value, 100 * g.wanted);
    return fmt::format(
        "places that were left out are foretold to {:.1f} times the noise (wanted {:g})", g.value,
        g.wanted);
  }
  if (!std::isfinite(g.value))
    return fmt::format("wanted to {:.2g} %, not told{}", 100 * g.wanted,
                       g.note.empty() ? " before the verdict is settled" : "");
  return fmt::format("known to {:.2g} % (wanted {:.2g})", 100 * g.value, 100 * g.wanted);
}

std::string state_words(const GoalState& g) {
  return bare_words(g) + (g.note.empty() ? "" : ": " + g.note);
}

// Of balls that are stiffer, but not much: what is stiffer still is seen deeper.
std::string sight_words(const std::vector<Sight>& sight) {
  double ratio = 0;
  for (const Sight& s : sight)
    if (s.ratio > 1 && (ratio == 0 || s.ratio < ratio)) ratio = s.ratio;
  std::string words;
  for (const Sight& s : sight)
    if (s.ratio == ratio)
      words +=
          fmt::format("{}one of {:.0f} mm {}", words.empty() ? "" : ", ", 2e3 * s.radius,
                      s.depth > 0 ? fmt::format("down to {:.0f} mm", 1e3 * s.depth) : "nowhere");
  if (words.empty()) return "";
  return fmt::format("Of balls {:g} times as stiff these presses see {}. ", ratio, words);
}

// What a verdict of no fault is worth: of what was pressed.
std::string gap_words(const Exploration& e) {
  return fmt::format(
      "{}Presses lie up to {:.0f} mm from the next place that could be pressed: what differs "
      "between "
      "or beside them, or deeper, is not known.",
      sight_words(e.sight), 1e3 * e.gap);
}

std::string untested_words(const std::vector<UntestedEffect>& untested) {
  std::string names;
  for (const UntestedEffect& u : untested) names += (names.empty() ? "" : ", ") + u.effect;
  return "Outside the verdict, for these presses cannot test them: " + names + " (why: --json).";
}

}  // namespace

Summary explore_summary(const Exploration& e, const std::string& recording,
                        const std::string& file) {
  Summary s;
  s.mark = e.reached ? Summary::Mark::kGood : Summary::Mark::kOpen;
  s.verdict = recording + ": " +
              (e.reached ? "enough is known"
               : e.ended ? "not enough is known, and no more presses are asked for"
                         : counted(e.plan.presses.size(), "press", "presses") + " to record next");
  s.size = fmt::format("{} at {}", counted(e.presses, "press", "presses"),
                       counted(e.places, "place", "places"));
  for (const GoalState& g : e.goals)
    s.items.push_back({g.reached       ? "REACHED"
                       : g.unreachable ? "NEVER"
                                       : "OPEN",
                       g.name,
                       "",
                       {state_words(g)}});
  if (!e.inside.empty()) s.notes.push_back(e.inside.front());
  if (e.diagnosis && std::isfinite(e.gap) && !e.goals.empty() && e.goals.front().reached)
    s.notes.push_back(gap_words(e));
  if (e.no_times)
    s.notes.push_back(
        "The recording has no column t: what goes on in time cannot be told, and is outside the "
        "verdict.");
  if (!e.untested.empty()) s.notes.push_back(untested_words(e.untested));
  if (e.ended) s.notes.push_back("No more: " + e.why + ".");
  if (e.done()) return s;
  s.notes.insert(s.notes.end(), e.shallower.begin(), e.shallower.end());
  s.notes.push_back(e.why + ":");
  constexpr std::size_t kShown = 6;
  for (std::size_t k = 0; k < std::min(kShown, e.plan.presses.size()); ++k) {
    const PlannedPress& p = e.plan.presses[k];
    s.notes.push_back(fmt::format("  at ({:.1f}, {:.1f}, {:.1f}) mm: {}", 1e3 * p.position.x(),
                                  1e3 * p.position.y(), 1e3 * p.position.z(), p.motion));
  }
  if (e.plan.presses.size() > kShown)
    s.notes.push_back(fmt::format("  and {} more", e.plan.presses.size() - kShown));
  if (!file.empty()) s.next = "record " + shell_quoted(file) + " and add its rows to the recording";
  return s;
}

}  // namespace hapsim
