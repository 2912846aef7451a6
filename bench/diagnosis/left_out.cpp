#include "left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>

#include "effects/catalogue.h"

namespace hapsim::bench {
namespace {

constexpr double kAtFloor = 1.1;  // errors over the floor below which nothing is left

// What may be said of each effect (LeftOver::kind), fixed before anything was diagnosed.
const std::map<std::string, std::vector<std::string>>& kinds() {
  static const std::vector<std::string> set_up{"set-up", "direction", "learned-axes"},
      body{"body", "place", "position", "learned-place"}, zero{"offset", "drift", "learned-drift"},
      depth{"depth", "learned-depth"}, time{"contact-time", "rate", "learned-kernel"},
      session{"session-time", "drift", "cycle", "learned-drift", "learned-gain"};
  static const std::map<std::string, std::vector<std::string>> table{
      {"viscoelastic", time},
      {"fractional", time},
      {"poroelastic", time},
      {"qlv", time},
      {"damper", time},
      {"sensor-lag", time},
      {"filter", time},
      {"clock", time},
      {"sensor-hysteresis", {"rate", "direction", "depth"}},
      {"hyperelastic", depth},
      {"tip", depth},
      {"sensor-curve", depth},
      {"deadband", depth},
      {"backlash", depth},
      {"adhesion", depth},
      {"friction", {"direction", "learned-axes"}},
      {"temperature", {"temperature"}},
      {"softening", session},
      {"plastic", {"depth", "learned-depth", "session-time", "cycle", "offset"}},
      {"sensor-drift", session},
      {"sensor-settling", session},
      {"sensor-hum", {"frequency", "session-time", "drift"}},
      {"breathing", {"frequency", "session-time", "drift", "rate", "contact-time"}},
      {"sensor-bias", zero},
      {"tare", zero},
      {"drag", {"offset", "rate"}},
      {"tool-inertia", {"rate", "direction", "event"}},
      {"sensor-rotation", set_up},
      {"sensor-gain", set_up},
      {"sensor-crosstalk", set_up},
      {"motion-scale", set_up},
      {"motion-rotation", set_up},
      {"arm-compliance", set_up},
      {"tool-radius", {"set-up", "body", "learned-place"}},
      {"regions", body},
      {"layer", body},
      {"pre-stress", {"set-up", "direction", "body", "learned-place"}},
      {"inclusion", body},
      {"anisotropic", {"set-up", "direction", "body", "learned-place"}},
      {"base", body}};
  return table;
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool states_no_cause(const std::string& effect) {
  const EffectCard& card = require_effect(effect).card();
  return card.learned || card.is_field;
}

const char* judged(const Trial& t) {
  if (!t.rivals.empty()) return "set";
  const auto& of = kinds().find(t.effects);
  const auto is_kind = [&](const std::string& said) {
    return of != kinds().end() && std::count(of->second.begin(), of->second.end(), said) > 0;
  };
  const std::vector<std::string> missing = words(t.missing);
  if (!missing.empty() && std::all_of(missing.begin(), missing.end(), states_no_cause))
    return std::any_of(missing.begin(), missing.end(), is_kind) ? "kind" : "open";
  if (!t.missing.empty()) return !t.left.empty() ? "hedged" : t.after <= kAtFloor ? "same" : "sure";
  if (t.verdict == "complete") return "unseen";
  return is_kind(t.left) ? "kind" : "open";
}

}  // namespace

bool is_of_kind(const std::string& hidden, const std::string& learned) {
  const auto of = kinds().find(hidden);
  return of != kinds().end() && std::count(of->second.begin(), of->second.end(), learned) > 0;
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
