// What hs-identify is asked to fit.
#pragma once

#include <optional>

#include "base/error.h"
#include "common_options.h"
#include "diagnose/diagnosis_table.h"
#include "effects/catalogue.h"
#include "fit/fit_request.h"
#include "hs-identify/flags.h"
#include "io/csv.h"
#include "model/model_edit.h"

namespace hapsim {

inline TermsRequest asked_terms(const Arguments& arguments) {
  return parse_terms(
      arguments.given(flag::terms) ? std::optional(arguments[flag::terms]) : std::nullopt,
      arguments.list(flag::windows));
}

inline FitRequest asked_fit(const Arguments& arguments) {
  FitRequest plan;
  plan.terms = asked_terms(arguments);
  plan.say = [&arguments](const std::string& text) { say(arguments, "hs-identify", text); };
  plan.fix = arguments.list(flag::fix);
  require_within_bounds(plan.fix);
  plan.automatic = arguments.list(flag::effects) == std::vector<std::string>{"auto"};
  if (plan.automatic && (arguments.given(flag::add) || arguments.given(flag::diagnosis)))
    fail_usage("--effects auto finds what to add by itself", "leave --add and --diagnosis out");
  if (arguments.given(flag::model)) {
    if (arguments.given(flag::effects) && !plan.automatic)
      fail_usage("--model and --effects exclude each other", "use --model with --add");
    plan.start = load_model(arguments, "hs-identify");
  } else if (!plan.automatic) {
    for (const std::string& effect : arguments.list(flag::effects))
      if (effect != body_effect().card().name) plan.add.push_back(effect);
  }
  for (const std::string& effect : arguments.list(flag::add)) plan.add.push_back(effect);
  if (arguments.given(flag::diagnosis)) {
    Input input(arguments[flag::diagnosis]);
    for (const std::string& effect : missing_effects(read_csv(input))) plan.add.push_back(effect);
  }
  for (const std::string& effect : plan.add) require_effect(effect);
  for (const std::string& effect : arguments.list(flag::remove)) remove_effect(plan.start, effect);
  for (const std::string& what : plan.fix)
    if (!plan.start.parameters.empty()) set_state(plan.start, what, ParameterState::kFixed);
  for (const std::string& what : arguments.list(flag::free))
    if (!plan.start.parameters.empty()) set_state(plan.start, what, ParameterState::kFree);
  return plan;
}

}  // namespace hapsim
