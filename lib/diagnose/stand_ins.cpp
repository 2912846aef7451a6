#include "diagnose/stand_ins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "diagnose/gates.h"
#include "diagnose/left_over.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

// any: of its card's kinds, not of the first alone.
bool is_of_kind(const std::string& effect, const std::string& kind, bool any) {
  const std::vector<std::string>& kinds = require_effect(effect).card().kinds;
  const auto end = any || kinds.empty() ? kinds.end() : kinds.begin() + 1;
  return std::find(kinds.begin(), end, kind) != end;
}

}  // namespace

StandIns find_stand_ins(const std::vector<LeftKind>& misfit,
                        const std::vector<std::string>& effects, double named,
                        const std::vector<LeftKind>& left) {
  constexpr double kPlainly = 0.1;
  if (misfit.empty() || effects.empty()) return {};
  const LeftKind& best = misfit.front();
  const bool plainly = best.share - named > kPlainly && 1 - named > 2 * (1 - best.share);
  const std::array<std::string, 4> own{kPress, kZeroOfPress, kPlaceAndWay, kWander};
  if (best.share < kMostOfIt || std::find(own.begin(), own.end(), best.kind) != own.end() ||
      std::any_of(effects.begin(), effects.end(), [&](const std::string& effect) {
        return is_of_kind(effect, best.kind, require_effect(effect).card().learned && !plainly);
      }))
    return {};
  double foretold = 0;  // of what is left
  for (const LeftKind& kind : left) foretold = std::max(foretold, kind.share);
  if (best.share < named && (1 - named) * (1 - foretold) <= kPlainly) return {};
  return {best.kind, effects, best.share, named};
}

std::string stand_in_words(const StandIns& s) {
  if (s.kind.empty()) return "";
  std::string names;
  for (const std::string& effect : s.effects) names += (names.empty() ? "" : ", ") + effect;
  return fmt::format(
      " Of the catalogue, {} came nearest, with {:.0f} % of it where it was fitted{}: no name "
      "of the cause, which goes with {} and has none here.",
      names, 100 * std::max(0.0, s.named), s.law < s.named ? ", and no law foretells the rest" : "",
      goes_with(s.kind));
}

std::string misfit_words(const std::vector<LeftKind>& misfit) {
  return misfit.empty()
             ? ""
             : fmt::format(
                   " All that the given model misses goes with {}: on presses that were left out "
                   "that alone foretells {:.0f} % of it.",
                   goes_with(misfit.front().kind), 100 * misfit.front().share);
}

}  // namespace hapsim
