// What hs-identify is asked to fit.
#pragma once

#include <optional>

#include "common_options.h"
#include "diagnose/diagnosis_table.h"
#include "fit/fit_request.h"
#include "hs-identify/flags.h"
#include "io/csv.h"

namespace hapsim {

inline TermsRequest asked_terms(const Arguments& arguments) {
  return parse_terms(
      arguments.given(flag::terms) ? std::optional(arguments[flag::terms]) : std::nullopt,
      arguments.list(flag::windows));
}

inline FitRequest asked_fit(const Arguments& arguments) {
  AskedFit asked;
  if (arguments.given(flag::model))
    asked.model = [&arguments] { return load_model(arguments, "hs-identify"); };
  asked.effects = arguments.list(flag::effects);
  asked.effects_given = arguments.given(flag::effects);
  asked.add = arguments.list(flag::add);
  asked.remove = arguments.list(flag::remove);
  asked.fix = arguments.list(flag::fix);
  asked.free = arguments.list(flag::free);
  if (arguments.given(flag::diagnosis))
    asked.diagnosed = [&arguments] {
      Input input(arguments[flag::diagnosis]);
      return missing_effects(read_csv(input));
    };
  if (arguments.given(flag::terms)) asked.terms = arguments[flag::terms];
  asked.windows = arguments.list(flag::windows);
  FitRequest plan = fit_request(asked);
  plan.say = [&arguments](const std::string& text) { say(arguments, "hs-identify", text); };
  return plan;
}

}  // namespace hapsim
