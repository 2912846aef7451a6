#include "fit/fit_request.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "fit/fit_words.h"
#include "io/number.h"
#include "model/model_edit.h"

namespace hapsim {

int parse_regions(const std::string& text, const std::string& option) {
  if (text == "auto") return kAutomaticRegions;
  if (text == "sites") return kEverySite;
  if (text == "labels") return kByLabel;
  double number = 0;
  if (!parse_number(text, number) || number < 1 || number != std::floor(number) || number > 10000)
    fail_usage(option + " " + text + " is not a number of regions",
               "give 2, auto, sites or labels");
  return static_cast<int>(number);
}

TermsRequest parse_terms(const std::optional<std::string>& terms,
                         const std::vector<std::string>& windows) {
  constexpr int kMost = 5;
  TermsRequest asked;
  for (const std::string& text : windows) {
    const std::size_t colon = text.find(':');
    double low = 0, high = 0;
    if (colon == std::string::npos || !parse_number(text.substr(0, colon), low) ||
        !parse_number(text.substr(colon + 1), high) || low <= 0 || high <= low)
      fail_usage("--windows " + text + " is no window of relaxation times",
                 "give LOW:HIGH in seconds: 0.05:1,2:30");
    asked.windows.emplace_back(low, high);
  }
  const std::string text = terms.value_or("1");
  double number = kMost;
  asked.automatic = text == "auto" || text.rfind("auto:", 0) == 0;
  const std::string count = !asked.automatic ? text : text == "auto" ? "5" : text.substr(5);
  if (!parse_number(count, number) || number < 1 || number != std::floor(number) || number > kMost)
    fail_usage("--terms " + text + " is not a number of terms",
               "give 1 to 5, auto, or auto:N for at most N");
  asked.count = static_cast<int>(number);
  if (asked.windows.empty()) return asked;
  if (terms && (asked.automatic || asked.count != static_cast<int>(asked.windows.size())))
    fail_usage(fmt::format("{} windows, but --terms {}", asked.windows.size(), text),
               "leave --terms out: each window is a term");
  asked.automatic = false;
  asked.count = static_cast<int>(asked.windows.size());
  return asked;
}

FitRequest fit_request(const AskedFit& asked) {
  FitRequest request;
  request.terms = parse_terms(asked.terms, asked.windows);
  request.fix = asked.fix;
  require_within_bounds(request.fix);
  request.automatic = asked.effects == std::vector<std::string>{"auto"};
  if (request.automatic && (!asked.add.empty() || asked.diagnosed))
    fail_usage("--effects auto finds what to add by itself", "leave --add and --diagnosis out");
  if (asked.model) {
    if (asked.effects_given && !request.automatic)
      fail_usage("--model and --effects exclude each other", "use --model with --add");
    request.start = asked.model();
  } else if (!request.automatic) {
    for (const std::string& effect : asked.effects)
      if (effect != body_effect().card().name) request.add.push_back(effect);
  }
  request.add.insert(request.add.end(), asked.add.begin(), asked.add.end());
  if (asked.diagnosed)
    for (const std::string& effect : asked.diagnosed()) request.add.push_back(effect);
  for (const std::string& effect : request.add) require_effect(effect);
  for (const std::string& effect : asked.remove) remove_effect(request.start, effect);
  if (request.start.parameters.empty()) return request;
  for (const std::string& what : asked.fix) set_state(request.start, what, ParameterState::kFixed);
  for (const std::string& what : asked.free) set_state(request.start, what, ParameterState::kFree);
  return request;
}

void require_within_bounds(const std::vector<std::string>& fix) {
  for (const std::string& what : fix) {
    const std::size_t equals = what.find('=');
    double value = 0;
    if (equals == std::string::npos || !parse_number(what.substr(equals + 1), value)) continue;
    const std::string name = what.substr(0, equals);
    std::string bounds;
    bool within = false;
    for (const Effect* effect : catalogue())
      for (const ParameterCard& p : effect->card().parameters) {
        if (name != p.name && name != effect->card().name + "." + p.name) continue;
        within = within || (value >= p.lower && value <= p.upper);
        bounds += fmt::format("{}{:g} to {:g}", bounds.empty() ? "" : " or ", p.lower, p.upper);
      }
    if (!bounds.empty() && !within)
      fail_usage(fmt::format("{} = {:g} is out of bounds", name, value),
                 "give a value from " + bounds);
  }
}

void set_poisson_range(const FitRequest& request, ExperimentOptions& options) {
  set_poisson_range(request.start, options);
  if (!request.start.parameters.empty()) return;
  for (const std::string& what : request.fix) {
    const bool is_nu =
        what.rfind("nu=", 0) == 0 || what.rfind(body_effect().card().name + ".nu=", 0) == 0;
    double nu = 0;
    if (is_nu && parse_number(what.substr(what.find('=') + 1), nu))
      options.nu_low = options.nu_high = nu;
  }
}

Starts build_starts(const FitRequest& request, const Experiment& w, const Selection& selection,
                    const FitOptions& fit_options, const ExtendOptions& extend,
                    const Linearisation& known) {
  Model model = request.start;
  if (model.parameters.empty()) {
    model = elastic_model(w, selection, request.add);
    for (const std::string& what : request.fix)
      if (what.find("nu") != std::string::npos) set_state(model, what, ParameterState::kFixed);
  }
  Starts starts{{model}, known};
  for (std::size_t k = 0; k < request.add.size(); ++k) {
    FitOptions quick = fit_options;
    quick.exact_regions = false;
    quick.starts = 1;  // the last fit searches
    const Fit base = fit_best(starts.models, w, selection, quick, starts.known);
    const EffectCard& card = require_effect(request.add[k]).card();
    const bool terms = card.terms && !card.is_map;
    FitOptions searching = quick;
    searching.starts = fit_options.starts;
    ExtendOptions own = extend;
    if (terms && request.terms.automatic) {
      const TermChoice choice =
          choose_terms(base, request.add[k], request.terms.count, w, selection, searching, extend);
      own.terms = choice.terms;
      if (request.say) request.say(choice_words(choice, request.add[k]));
    }
    starts = {with_effect(base, request.add[k], w, selection, own), base.about};
    if (terms && !request.terms.windows.empty())
      for (Model& start : starts.models) set_windows(start, request.add[k], request.terms.windows);
  }
  for (Model& start : starts.models)
    for (const std::string& what : request.fix) set_state(start, what, ParameterState::kFixed);
  return starts;
}

HeldOut held_out_error(const FitRequest& request, const Model& fitted, const Experiment& experiment,
                       const Folds& folds, const FitOptions& fit_options,
                       const ExtendOptions& extend) {
  FitOptions quick = fit_options;
  quick.exact_regions = false;
  quick.starts = 1;
  quick.keep = nullptr;
  FitRequest refit = request;
  refit.start = fitted;
  refit.add.clear();
  refit.say = nullptr;
  if (const std::string& map = map_effect().card().name; refit.start.has(map)) {
    remove_effect(refit.start, map);
    refit.add.push_back(map);
  }
  const Linearisation known = experiment.places.solve(material_of(refit.start));
  const ModelBuilder builder = [&](const Selection& training) {
    return build_starts(refit, experiment, training, quick, extend, known);
  };
  return held_out_error(builder, experiment, folds, quick);
}

}  // namespace hapsim
