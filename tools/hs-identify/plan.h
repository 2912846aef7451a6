// What hs-identify is asked to fit: the start, the effects to add, how many terms and regions.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "common_options.h"
#include "effects/catalogue.h"
#include "fit/extend.h"
#include "fit/maxwell_terms.h"
#include "io/csv.h"
#include "model/model_edit.h"

namespace hapsim {

inline int regions_asked(const std::string& text) {
  if (text == "auto") return kAutomaticRegions;
  if (text == "sites") return kEverySite;
  double number = 0;
  if (!parse_number(text, number) || number < 1 || number != std::floor(number) || number > 10000)
    fail_usage("--regions " + text + " is not a number of regions", "give 2, auto or sites");
  return static_cast<int>(number);
}

struct TermsAsked {
  int count = 1;
  bool automatic = false;  // `count` is the most that is offered
  TimeWindows windows;
};

inline TermsAsked terms_asked(const Arguments& arguments) {
  constexpr int kMost = 5;
  TermsAsked asked;
  for (const std::string& text : arguments.list("--windows")) {
    const std::size_t colon = text.find(':');
    double low = 0, high = 0;
    if (colon == std::string::npos || !parse_number(text.substr(0, colon), low) ||
        !parse_number(text.substr(colon + 1), high) || low <= 0 || high <= low)
      fail_usage("--windows " + text + " is no window of relaxation times",
                 "give LOW:HIGH in seconds: 0.05:1,2:30");
    asked.windows.emplace_back(low, high);
  }
  const std::string text = arguments.text("--terms");
  double number = kMost;
  asked.automatic = text == "auto" || text.rfind("auto:", 0) == 0;
  const std::string count = !asked.automatic ? text : text == "auto" ? "5" : text.substr(5);
  if (!parse_number(count, number) || number < 1 || number != std::floor(number) || number > kMost)
    fail_usage("--terms " + text + " is not a number of terms",
               "give 1 to 5, auto, or auto:N for at most N");
  asked.count = static_cast<int>(number);
  if (asked.windows.empty()) return asked;
  if (arguments.given("--terms") &&
      (asked.automatic || asked.count != static_cast<int>(asked.windows.size())))
    fail_usage(fmt::format("{} windows, but --terms {}", asked.windows.size(), text),
               "leave --terms out: each window is a term");
  asked.automatic = false;
  asked.count = static_cast<int>(asked.windows.size());
  return asked;
}

struct IdentifyPlan {
  Model start;                   // empty: elastic from the data
  bool automatic = false;        // what to add is found by diagnosis
  std::vector<std::string> add;  // in order
  std::vector<std::string> fix, free;
  TermsAsked terms;
  std::function<void(const std::string&)> say;  // what was chosen on the way; may be empty
};

// The effects that a diagnosis calls missing, in order of rank.
inline std::vector<std::string> missing_effects(const std::string& path) {
  Input input(path);
  const CsvTable table = read_csv(input);
  const int effect = table.find("effect"), verdict = table.find("verdict");
  if (effect < 0 || verdict < 0)
    fail_input(table.name, "this is no diagnosis: it has no columns effect and verdict",
               "give a file that hs-diagnose wrote");
  std::vector<std::string> missing;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (table.columns[verdict][row] == "missing") missing.push_back(table.columns[effect][row]);
  return missing;
}

inline IdentifyPlan make_plan(const Arguments& arguments) {
  IdentifyPlan plan;
  plan.terms = terms_asked(arguments);
  plan.say = [&arguments](const std::string& text) { say(arguments, "hs-identify", text); };
  plan.fix = arguments.list("--fix");
  plan.free = arguments.list("--free");
  plan.automatic = arguments.list("--effects") == std::vector<std::string>{"auto"};
  if (plan.automatic && (arguments.given("--add") || arguments.given("--diagnosis")))
    fail_usage("--effects auto finds what to add by itself", "leave --add and --diagnosis out");
  if (arguments.given("--model")) {
    if (arguments.given("--effects") && !plan.automatic)
      fail_usage("--model and --effects exclude each other", "use --model with --add");
    plan.start = load_model(arguments, "hs-identify");
  } else if (!plan.automatic) {
    for (const std::string& effect : arguments.list("--effects"))
      if (effect != body_effect().card().name) plan.add.push_back(effect);
  }
  for (const std::string& effect : arguments.list("--add")) plan.add.push_back(effect);
  if (arguments.given("--diagnosis"))
    for (const std::string& effect : missing_effects(arguments.text("--diagnosis")))
      plan.add.push_back(effect);
  for (const std::string& effect : plan.add) require_effect(effect);
  for (const std::string& effect : arguments.list("--remove")) remove_effect(plan.start, effect);
  for (const std::string& what : plan.fix)
    if (!plan.start.parameters.empty()) set_state(plan.start, what, ParameterState::kFixed);
  for (const std::string& what : plan.free)
    if (!plan.start.parameters.empty()) set_state(plan.start, what, ParameterState::kFree);
  return plan;
}

}  // namespace hapsim
