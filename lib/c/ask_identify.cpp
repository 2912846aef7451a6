#include <algorithm>

#include "base/error.h"
#include "c/handles.h"
#include "c/options.h"
#include "cli/shared_flags.h"
#include "effects/catalogue.h"
#include "experiment/plausible.h"
#include "experiment/preparation_flags.h"
#include "fit/constraint_regions.h"
#include "fit/constraints.h"
#include "fit/fit_words.h"
#include "identify/identify.h"
#include "recording/tools_together.h"

struct hs_identification {
  hs_model model;
  std::string json;
};

using namespace hapsim;

namespace {

constexpr TextFlag kEffects{"--effects"}, kAdd{"--add"}, kRemove{"--remove"}, kFix{"--fix"},
    kFree{"--free"}, kConstrain{"--constrain"}, kRegionNames{"--region-names"}, kTerms{"--terms"},
    kRegions{"--regions"};
constexpr TimesFlag kWindows{"--windows"};
constexpr IntegerFlag kIdentifyFolds{"--folds"}, kStarts{"--starts"}, kIdentifySeed{"--seed"};
constexpr ChoiceFlag kRobust{"--robust"};
constexpr SwitchFlag kProfile{"--profile"};

std::vector<Option> known_to_identify() {
  std::vector<Option> known = preparation_flags();
  const std::vector<Option> own{
      {.flag = kEffects,
       .value = "LIST",
       .default_text = body_effect().card().name,
       .repeatable = true},
      {.flag = kAdd, .value = "LIST", .repeatable = true},
      {.flag = kRemove, .value = "LIST", .repeatable = true},
      {.flag = kFix, .value = "LIST", .repeatable = true},
      {.flag = kFree, .value = "LIST", .repeatable = true},
      {.flag = kConstrain, .value = "FORMULA", .repeatable = true},
      {.flag = kRegionNames, .value = "LIST"},
      {.flag = kTerms, .value = "N"},
      {.flag = kWindows, .value = "LIST", .repeatable = true},
      {.flag = kRegions, .value = "N", .default_text = "auto"},
      {.flag = kIdentifyFolds, .value = "N", .default_text = "6", .minimum = 0, .maximum = 1000},
      {.flag = kRobust,
       .value = "LOSS",
       .default_text = "none",
       .choices = {"none", "huber", "tukey"}},
      {.flag = kProfile},
      {.flag = kStarts, .value = "N", .default_text = "1", .minimum = 1, .maximum = 100000},
      {.flag = kIdentifySeed, .value = "N", .default_text = "1", .minimum = 0}};
  known.insert(known.end(), own.begin(), own.end());
  return known;
}

IdentifyRequest request_of(const Asked& asked, const hs_model* start) {
  const Arguments& arguments = asked.arguments();
  AskedFit words;
  if (start != nullptr)
    words.model = [&] {
      for (const std::string& doubt : doubts_of(start->model)) asked.say()(doubt);
      return start->model;
    };
  words.effects = arguments.list(kEffects);
  words.effects_given = arguments.given(kEffects);
  words.add = arguments.list(kAdd);
  words.remove = arguments.list(kRemove);
  words.fix = arguments.list(kFix);
  words.free = arguments.list(kFree);
  if (arguments.given(kTerms)) words.terms = arguments[kTerms];
  words.windows = arguments.list(kWindows);
  IdentifyRequest request;
  request.fit = fit_request(words);
  if (arguments.given(kRegionNames)) {
    region_names(arguments[kRegionNames], kRegionNames.name);  // refused at once
    request.fit.start.metadata.set("region_names", arguments[kRegionNames]);
  }
  request.fit.say = request.say = asked.say();
  request.regions = parse_regions(arguments[kRegions], kRegions.name);
  request.folds = static_cast<int>(arguments[kIdentifyFolds]);
  request.options.starts = static_cast<int>(arguments[kStarts]);
  request.options.seed = static_cast<std::uint64_t>(arguments[kIdentifySeed]);
  request.options.robust = robust_loss(arguments[kRobust]);
  request.options.profile = arguments[kProfile];
  request.options.constraints = parse_constraints(arguments.list(kConstrain), kConstrain.name);
  request.options.watch = [stop = asked.stop()](const FitProgress&) { return !stop(); };
  return request;
}

GivenRecordings given_to(const Asked& asked, const hs_body* const* bodies, std::size_t body_count,
                         const hs_recording* const* recordings, std::size_t recording_count,
                         const Model& start) {
  require_bodies_for(body_count, recording_count);
  GivenRecordings all;
  std::vector<int> body_of;
  for (std::size_t k = 0; k < body_count; ++k) {
    const auto same = std::find(bodies, bodies + k, bodies[k]) - bodies;
    if (static_cast<std::size_t>(same) < k) {
      body_of.push_back(body_of[static_cast<std::size_t>(same)]);
      continue;
    }
    body_of.push_back(static_cast<int>(all.bodies.size()));
    all.bodies.push_back(bodies[k]->mesh);
    all.windows.push_back(bodies[k]->window);
  }
  body_of.resize(recording_count, body_of.front());
  std::vector<Recording> pressed;
  for (std::size_t k = 0; k < recording_count; ++k)
    pressed.push_back(as_asked(asked.arguments(), recordings[k]->recording, true, asked.say()));
  join_given(all, body_of, std::move(pressed), start);
  return all;
}

}  // namespace

hs_status hs_identify(const hs_body* const* bodies, size_t body_count,
                      const hs_recording* const* recordings, size_t recording_count,
                      const hs_model* start, const hs_options* options,
                      hs_identification** identification) {
  return made(identification, [&] {
    const Asked asked("hs-identify", known_to_identify(), options);
    const auto say = asked.say();
    const IdentifyRequest request = request_of(asked, start);
    GivenRecordings all =
        given_to(asked, bodies, body_count, recordings, recording_count, request.fit.start);
    require_fit_for(request.fit, all.dataset);
    if (const std::string words = tools_together(all.dataset.recording); !words.empty()) say(words);
    ExperimentOptions prepared = preparation_options(asked.arguments());
    set_poisson_range(request.fit, prepared);
    prepared.windows = all.windows;
    for (const std::string& words : doubts_of(request.fit.start, all.bodies)) say(words);
    const Experiment w = make_experiment(all.bodies, std::move(all.dataset), prepared);
    for (const std::string& words : left_out_words(w)) say(words);
    Identification found = identify(request, all.bodies.front(), w, prepared);
    if (found.fitted.stopped || !found.cut_short.empty())
      fail_numerics(w.dataset.recording.name, "the fit was stopped", "let it go on to the end");
    auto handle = std::make_unique<hs_identification>();
    handle->json = summary_json(identification_summary(found, w), "hs-identify");
    handle->model.model = std::move(found.fitted.model);
    return handle;
  });
}

void hs_identification_free(hs_identification* identification) {
  delete identification;
}

const hs_model* hs_identification_model(const hs_identification* identification) {
  return &identification->model;
}

const char* hs_identification_json(const hs_identification* identification) {
  return identification->json.c_str();
}
