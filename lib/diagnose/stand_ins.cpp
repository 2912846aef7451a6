#include "diagnose/stand_ins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "diagnose/left_over.h"
#include "effects/catalogue.h"

namespace hapsim {

StandIns find_stand_ins(const std::vector<LeftKind>& misfit,
                        const std::vector<std::string>& effects, double named) {
  constexpr double kMore = 0.1, kTimes = 2;
  if (misfit.empty() || effects.empty()) return {};
  const LeftKind& best = misfit.front();
  const auto is_best = [&](const std::string& kind) { return kind == best.kind; };
  const std::array<std::string, 4> own{kPress, kZeroOfPress, kPlaceAndWay, kWander};
  if (std::any_of(own.begin(), own.end(), is_best) ||
      std::any_of(effects.begin(), effects.end(), [&](const std::string& effect) {
        const std::vector<std::string>& kinds = require_effect(effect).card().kinds;
        return !kinds.empty() && is_best(kinds.front());
      }))
    return {};
  if (best.share - named < kMore || 1 - named < kTimes * (1 - best.share)) return {};
  return {best.kind, best.share, named};
}

std::string misfit_words(const std::vector<LeftKind>& misfit, const StandIns& s) {
  if (misfit.empty()) return "";
  if (s.kind.empty())
    return fmt::format(
        " All that the given model misses goes with {}: on presses that were left out that alone "
        "foretells {:.0f} % of it.",
        goes_with(misfit.front().kind), 100 * misfit.front().share);
  return fmt::format(
      " But what the given model misses goes with {}: on presses that were left out that alone "
      "foretells {:.0f} % of it, while what is named here takes {:.0f} %. So the names stand in "
      "for a cause of that kind which has none here.",
      goes_with(s.kind), 100 * s.law, 100 * std::max(0.0, s.named));
}

}  // namespace hapsim
