#include "explore/explore_summary.h"

#include <fmt/format.h>

#include <cmath>

#include "base/counted.h"
#include "base/shell_words.h"

namespace hapsim {
namespace {

std::string state_words(const GoalState& g) {
  if (!g.said.empty() && g.wanted == 0)
    return g.said + (g.reached ? "; settled" : "; not settled yet");
  if (g.name == "lump") {
    if (!std::isfinite(g.value)) return "none is seen so far";
    return fmt::format("seen, its centre within ± {:.1f} mm (wanted {:.1f})", 1e3 * g.value,
                       1e3 * g.wanted);
  }
  if (!std::isfinite(g.value))
    return fmt::format("wanted to {:.2g} %: not told before the verdict is settled",
                       100 * g.wanted);
  return fmt::format("known to {:.2g} % (wanted {:.2g})", 100 * g.value, 100 * g.wanted);
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
    s.items.push_back({g.reached ? "REACHED" : "OPEN", g.name, "", {state_words(g)}});
  if (!e.inside.empty()) s.notes.push_back(e.inside.front());
  if (e.ended) s.notes.push_back("As many presses as --most-presses allows are there.");
  if (e.done()) return s;
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
