#include "left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>

#include "diagnose/of_one_kind.h"
#include "effects/catalogue.h"

namespace hapsim::bench {
namespace {

constexpr double kAtFloor = 1.1;  // errors over the floor below which nothing is left

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool states_no_cause(const std::string& effect) {
  const EffectCard& card = require_effect(effect).card();
  return card.learned || card.is_field;
}

bool is_kind_of(const std::string& hidden, const std::string& kind) {
  const std::vector<std::string>& kinds = require_effect(hidden).card().kinds;
  return std::count(kinds.begin(), kinds.end(), kind) > 0;
}

// What is named instead is first of all of a kind of what is hidden.
bool is_kin(const std::string& hidden, const std::string& named) {
  const std::vector<std::string>& kinds = require_effect(named).card().kinds;
  return !kinds.empty() && is_kind_of(hidden, kinds.front());
}

const char* judged(const Trial& t) {
  const std::vector<std::string> missing = words(t.missing), rivals = words(t.rivals);
  if (!rivals.empty())
    return std::any_of(rivals.begin(), rivals.end(),
                       [&](const std::string& rival) { return is_kin(t.effects, rival); })
               ? "set"
           : t.left.empty() ? "sure"
                            : "hedged";
  if (!missing.empty() && std::all_of(missing.begin(), missing.end(), states_no_cause))
    return std::any_of(missing.begin(), missing.end(),
                       [&](const std::string& curve) { return is_of_kind(t.effects, curve); })
               ? "kind"
               : "open";
  // Several names of one kind stand for that kind.
  if (is_kind_of(t.effects, kind_of_several(missing).kind)) return "kind";
  if (!missing.empty()) {
    if (!t.left.empty()) return "hedged";
    if (t.after <= kAtFloor) return "same";
    return std::all_of(missing.begin(), missing.end(),
                       [&](const std::string& named) { return is_kin(t.effects, named); })
               ? "kin"
               : "sure";
  }
  if (t.verdict == "complete") return "unseen";
  return is_kind_of(t.effects, t.left) ? "kind" : "open";
}

}  // namespace

bool is_of_kind(const std::string& hidden, const std::string& learned) {
  if (!states_no_cause(learned)) return false;
  const std::vector<std::string>& kinds = require_effect(learned).card().kinds;
  return std::any_of(kinds.begin(), kinds.end(),
                     [&](const std::string& kind) { return is_kind_of(hidden, kind); });
}

bool can_be_left_out(const Truth& truth) {
  return truth.effects.size() == 1 && truth.base.empty() && truth.presses == 0;
}

void print_left_out(const std::vector<Trial>& trials) {
  std::map<std::string, int> counts;
  fmt::print("{:<24} {:>5} {:<12} {:<40} {:<13} {:>6} {:>6}  judged\n", "truth", "level", "verdict",
             "named {alike}", "left", "before", "after");
  for (const Trial& t : trials) {
    const char* const what = judged(t);
    ++counts[what];
    const std::string alike = t.rivals.empty() ? "" : "{" + t.rivals + "}";
    fmt::print("{:<24} {:>5.2g} {:<12} {:<40} {:<13} {:>6.2f} {:>6.2f}  {}\n", t.truth, t.level,
               t.verdict, t.missing + alike, t.left.empty() ? "-" : t.left, t.now, t.after, what);
  }
  fmt::print("\n");
  for (const auto& [what, n] : counts) fmt::print("{:<8} {:>4} of {}\n", what, n, trials.size());
}

}  // namespace hapsim::bench
