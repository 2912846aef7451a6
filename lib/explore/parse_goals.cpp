#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "base/error.h"
#include "effects/catalogue.h"
#include "explore/goals.h"
#include "io/quantity.h"
#include "model/model.h"

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

// Times the noise, than which no model does better, or a share of the force.
WantedUnseen unseen_wanted(const std::string& text, const std::string& word,
                           const std::string& option) {
  if (!text.empty() && text.back() == '%') return {share_of(text, word, option), true};
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !(value > 1 && value < 1e6))
    fail_usage(fmt::format("{}: '{}' has no number above 1", option, word),
               "write unseen=2 for twice the noise, or unseen=5% of the force");
  return {value, false};
}

// "E", or "elastic.E" of "elastic.E" and "elastic E", as summaries write it; of some effect.
std::string parameter_of(std::string name, const std::string& word, const std::string& option) {
  std::replace(name.begin(), name.end(), ' ', '.');
  const std::size_t dot = name.find('.');
  const std::string effect = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string parameter = dot == std::string::npos ? name : name.substr(dot + 1);
  const std::vector<const Effect*>& all = catalogue();
  const bool known = std::any_of(all.begin(), all.end(), [&](const Effect* e) {
    return (effect.empty() || e->card().name == effect) && parameter_card(*e, parameter) != nullptr;
  });
  if (!known)
    fail_usage(fmt::format("{}: '{}' is of a parameter that no effect has", option, word),
               "write PARAMETER=SHARE or EFFECT.PARAMETER=SHARE with names of hs-effects(7)");
  return name;
}

// "E" and "elastic.E" are one.
bool same_kind(const std::string& a, const std::string& b) {
  const auto ends = [](const std::string& full, const std::string& parameter) {
    const std::size_t dot = full.find('.');
    return dot != std::string::npos && full.substr(dot + 1) == parameter;
  };
  return a == b || ends(a, b) || ends(b, a);
}

[[noreturn]] void fail_twice(const std::string& word, const std::string& option) {
  fail_usage(fmt::format("{}: '{}' is asked for twice", option, word),
             "give one goal of a kind, the stricter one");
}

}  // namespace

Goals parse_goals(const std::vector<std::string>& words, const std::string& option) {
  Goals goals;
  bool verdict = false;  // asked for by itself
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    if (word == "verdict") {
      if (verdict) fail_twice(word, option);
      goals.verdict = verdict = true;
    } else if (equals == std::string::npos || name.empty() || name == "verdict") {
      fail_usage(fmt::format("{}: '{}' is no goal", option, word),
                 "write verdict, PARAMETER=SHARE as in E=0.02, unseen=NUMBER as in unseen=2, or "
                 "lump=LENGTH as in lump=2mm");
    } else if (name == "unseen") {
      if (goals.unseen.value > 0) fail_twice(word, option);
      goals.unseen = unseen_wanted(word.substr(equals + 1), word, option);
      goals.verdict = true;
    } else if (name == "lump") {
      if (goals.lump > 0) fail_twice(word, option);
      goals.lump = parse_length(word.substr(equals + 1), option + ": lump");
      if (!(goals.lump > 0 && goals.lump < 1))
        fail_usage(fmt::format("{}: '{}' is no length between 0 and 1 m", option, word),
                   "write lump=2mm");
    } else {
      const WantedError wanted{parameter_of(name, word, option),
                               share_of(word.substr(equals + 1), word, option)};
      for (const WantedError& other : goals.errors)
        if (same_kind(wanted.parameter, other.parameter)) fail_twice(word, option);
      goals.errors.push_back(wanted);
      goals.verdict = true;
    }
  }
  return goals;
}

}  // namespace hapsim
