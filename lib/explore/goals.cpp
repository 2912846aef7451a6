#include "explore/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/quantity.h"

namespace hapsim {
namespace {

double share_of(const std::string& text, const std::string& word, const std::string& option) {
  const bool percent = !text.empty() && text.back() == '%';
  const char* const end = text.data() + text.size() - (percent ? 1 : 0);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) value = std::numeric_limits<double>::quiet_NaN();
  if (percent) value /= 100;
  if (!(value > 0 && value <= 1))
    fail_usage(fmt::format("{}: '{}' has no share between 0 and 1", option, word),
               "write E=0.02 or E=2%");
  return value;
}

}  // namespace

Goals parse_goals(const std::vector<std::string>& words, const std::string& option) {
  Goals goals;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    if (word == "verdict") {
      goals.verdict = true;
    } else if (equals == std::string::npos || name.empty() || name == "verdict") {
      fail_usage(fmt::format("{}: '{}' is no goal", option, word),
                 "write verdict, PARAMETER=SHARE as in E=0.02, or lump=LENGTH as in lump=2mm");
    } else if (name == "lump") {
      goals.lump = parse_length(word.substr(equals + 1), option + ": lump");
      if (!(goals.lump > 0 && goals.lump < 1))
        fail_usage(fmt::format("{}: '{}' is no length between 0 and 1 m", option, word),
                   "write lump=2mm");
    } else {
      goals.errors.push_back({name, share_of(word.substr(equals + 1), word, option)});
      goals.verdict = true;
    }
  }
  return goals;
}

bool settles(const Diagnosis& d, std::size_t presses) {
  if (presses < kLeastPresses) return false;
  const bool left = !d.left.noise_alone() || !d.torque.explained() || !d.marker.explained();
  return d.verdict == ModelVerdict::kComplete || (d.verdict == ModelVerdict::kIncomplete && !left);
}

GoalState verdict_state(const Diagnosis& d, std::size_t presses) {
  std::string names;
  for (const Finding& f : d.findings) {
    const bool rival = f.verdict == Verdict::kIndistinguishable;
    if (f.verdict != Verdict::kMissing && !rival) continue;
    names += (names.empty() ? ": " : rival ? " | " : " + ") + f.effect;
  }
  return {"verdict", verdict_name(d.verdict) + names, 0, 0, settles(d, presses)};
}

GoalState error_state(const WantedError& wanted, const Model& model) {
  GoalState state{wanted.parameter, "", -1, wanted.share, false};
  for (const int k : model.free_parameters()) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(k)];
    if (p.name != wanted.parameter && p.effect + "." + p.name != wanted.parameter) continue;
    const double error = std::abs(p.std_error / p.value);
    // Of several regions the least certain.
    if (state.value < 0 || !(error <= state.value)) {
      state.value = error;
      state.name = p.effect + " " + p.name;
    }
  }
  if (state.value < 0)
    fail_usage(fmt::format("the model that the presses ask for has no free parameter {}",
                           wanted.parameter),
               "ask for one that it has, or leave it out of the goals");
  state.reached = state.value <= wanted.share;
  return state;
}

GoalState lump_state(double wanted, const StiffnessImage& image) {
  if (image.lumps.empty())
    return {"lump", "not seen", std::numeric_limits<double>::quiet_NaN(), wanted, false};
  const Lump& lump = image.lumps.front();
  double widest = 0;
  for (const Interval* i : {&lump.x, &lump.y, &lump.z})
    widest = std::max(widest, (i->high - i->low) / 2);
  return {"lump", "seen", widest, wanted, widest <= wanted};
}

}  // namespace hapsim
