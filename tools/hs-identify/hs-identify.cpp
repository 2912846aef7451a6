// hs-identify: the material and sensor parameters that explain a recording.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/error.h"
#include "common_options.h"
#include "diagnose/improve.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "experiment/plausible.h"
#include "fit/extend.h"
#include "fit/location_fit.h"
#include "fit/maxwell_terms.h"
#include "hs-identify/acfm.h"
#include "hs-identify/boundary.h"
#include "hs-identify/follow.h"
#include "hs-identify/image.h"
#include "hs-identify/library.h"
#include "hs-identify/plan.h"
#include "hs-identify/recordings.h"
#include "hs-identify/report.h"
#include "hs-identify/search.h"
#include "hs-identify/specification.h"
#include "hs-identify/until.h"
#include "model/model_edit.h"
#include "model/model_history.h"

namespace hapsim {
namespace {

std::string words_of(const TermChoice& choice, const std::string& effect) {
  std::string trials;
  for (const TermTrial& t : choice.trials)
    trials += fmt::format(
        "{}{}: error {:.4g} N{}", trials.empty() ? "" : "; ", t.terms, t.fit.error.told(),
        std::isnan(t.held_out.pooled) ? "" : fmt::format(", unseen {:.4g} N", t.held_out.told()));
  return fmt::format("{} of {} chosen ({})", counted(choice.terms, "term", "terms"), effect,
                     trials);
}

// Models to fit on the chosen episodes: fitted step by step, one effect after the other.
Starts build(const IdentifyPlan& plan, const Experiment& w, const Selection& selection,
             const FitOptions& fit_options, const ExtendOptions& extend,
             const Linearisation& known = {}) {
  Model model = plan.start;
  if (model.parameters.empty()) {
    model = elastic_model(w, selection);
    for (const std::string& what : plan.fix)
      if (what.find("nu") != std::string::npos) set_state(model, what, ParameterState::kFixed);
  }
  Starts starts{{model}, known};
  for (std::size_t k = 0; k < plan.add.size(); ++k) {
    FitOptions quick = fit_options;
    quick.exact_regions = false;
    quick.starts = 1;  // the last fit searches
    const Fit base = fit_best(starts.models, w, selection, quick, starts.known);
    const EffectCard& card = require_effect(plan.add[k]).card();
    const bool terms = card.terms && !card.is_map;
    FitOptions searching = quick;
    searching.starts = fit_options.starts;
    ExtendOptions own = extend;
    if (terms && plan.terms.automatic) {
      const TermChoice choice =
          choose_terms(base, plan.add[k], plan.terms.count, w, selection, searching, extend);
      own.terms = choice.terms;
      if (plan.say) plan.say(words_of(choice, plan.add[k]));
    }
    starts = {with_effect(base, plan.add[k], w, selection, own), base.about};
    if (terms && !plan.terms.windows.empty())
      for (Model& start : starts.models) set_windows(start, plan.add[k], plan.terms.windows);
  }
  for (Model& start : starts.models)
    for (const std::string& what : plan.fix) set_state(start, what, ParameterState::kFixed);
  return starts;
}

// Adds what a diagnosis finds missing, step by step; each step goes into the history.
Improvement improve_step_by_step(const Arguments& arguments, const IdentifyPlan& plan,
                                 const TetMesh& body, ExperimentOptions options,
                                 const FitOptions& fit_options, const Experiment& w,
                                 double force_rms) {
  options.draft = true;
  options.progress = nullptr;
  const Experiment draft = make_experiment({body}, w.dataset, options);
  ImproveOptions improve_options;
  improve_options.fit = fit_options;
  improve_options.diagnose.folds = static_cast<int>(arguments.integer("--folds"));
  improve_options.diagnose.seed = fit_options.seed;
  improve_options.progress = [&](const std::string& what) {
    if (arguments.verbose()) say(arguments, "hs-identify", what);
  };
  Model start = plan.start;
  if (start.parameters.empty()) {
    start = elastic_model(w, all_episodes(w.dataset));
    for (const std::string& what : plan.fix) set_state(start, what, ParameterState::kFixed);
  }
  Improvement improvement = improve(start, w, draft, improve_options);
  for (std::size_t k = 0; k < improvement.steps.size(); ++k) {
    const ImprovementStep& step = improvement.steps[k];
    const std::string label = effects_label(step.fitted.model);
    const double rmse = step.fitted.error.told(), held_out = step.held_out.told();
    say(arguments, "hs-identify",
        fmt::format("{}: error {:.4g} N{}, {:.3g} x noise", label, rmse,
                    std::isnan(held_out) ? "" : fmt::format(", unseen {:.4g} N", held_out),
                    rmse / w.noise.value));
    // The last step is the model itself, which run() writes down.
    if (arguments.given("--history") && k + 1 < improvement.steps.size())
      add_history(arguments.text("--history"),
                  {arguments.output() + ": " + label, label, rmse, held_out, w.noise.value,
                   force_rms, static_cast<int>(step.fitted.model.free_parameters().size())});
  }
  if (improvement.stopped) return improvement;
  if (!improvement.refused.empty())
    say(arguments, "hs-identify",
        improvement.refused + " was called missing but does not help on unseen presses: left out");
  else
    say(arguments, "hs-identify",
        verdict_name(improvement.last.verdict) + ": " + improvement.last.explanation);
  return improvement;
}

void describe_fit(Fit& fitted, const IdentifyPlan& plan, const Experiment& w) {
  Model& model = fitted.model;
  model.metadata = plan.start.metadata;
  unmark(model);
  for (const char* key : {"heldout", "until", "heldout_later"}) model.metadata.remove(key);
  model.metadata.set("rmse", format_number(fitted.error.told()));
  model.metadata.set("force_noise", format_number(w.noise.value));
  if (w.dataset.tools() > 1)
    model.metadata.remove("tool_radius");
  else
    model.metadata.set("tool_radius", format_number(w.dataset.setups.front().tool_radius));
}

// The best so far of a fit that a signal ended, marked.
int write_unfinished(const Arguments& arguments, const IdentifyPlan& plan, const Experiment& w,
                     Fit result, const SearchState& search) {
  SearchState state = search;
  state.done = result.starts_done;
  describe_fit(result, plan, w);
  mark_unfinished(result.model, state);
  Output output(arguments.output());
  write_model(output.stream(), result.model);
  output.commit();
  fail_numerics(
      w.dataset.recording.name,
      fmt::format(
          "the fit was interrupted{}; the best so far, error {:.4g} N, is written",
          state.starts > 1 ? fmt::format(" after {} of {} starts", state.done, state.starts) : "",
          result.error.told()),
      state.starts > 1 ? "go on with --model and --resume" : "go on with --model");
}

// A stream knows its own flags and the body's alone.
void refuse_other_flags(const Arguments& arguments) {
  std::vector<std::string> known{"--body", "--tool-radius", "--threads", "--cache"};
  for (const Option& option : follow_flags()) known.push_back(option.flag);
  for (const Option& option : identify_specification().options)
    if (arguments.given(option.flag) &&
        std::find(known.begin(), known.end(), option.flag) == known.end())
      fail_usage(option.flag + " is of recordings, and --follow reads a stream",
                 "leave one of them out");
  if (arguments.list("--body").size() > 1)
    fail_usage("--follow is for one body", "give --body once");
}

int run(const Arguments& arguments) {
  if (arguments.given("--follow")) {
    refuse_other_flags(arguments);
    return run_follow(arguments);
  }
  for (const Option& option : follow_flags())
    if (arguments.given(option.flag))
      fail_usage(option.flag + " is of a stream", "add --follow, or leave it out");
  if (arguments.given("--acfm")) return run_acfm(arguments);
  if (arguments.given("--stiffening"))
    fail_usage("--stiffening is of analytical models", "add --acfm N, or --add hyperelastic");
  const IdentifyPlan plan = make_plan(arguments);
  ExtendOptions extend;
  extend.regions = regions_asked(arguments.text("--regions"));
  extend.terms = plan.terms.count;
  const SearchState search = search_asked(arguments, plan.start);
  GivenRecordings given = load_recordings(arguments);
  require_fit_for(arguments, plan, given.dataset);
  RestOfPress rest(arguments, given);
  const TetMesh& body = given.bodies.front();
  IdentifyLibrary library(arguments, given.dataset.recording, body);
  std::shared_ptr<Progress> progress;
  ExperimentOptions options = experiment_options(arguments, progress);
  set_poisson_range(plan.start, options);
  if (plan.start.parameters.empty())
    for (const std::string& what : plan.fix) {
      const bool is_nu = what.rfind("nu=", 0) == 0 || what.rfind("elastic.nu=", 0) == 0;
      double nu = 0;
      if (is_nu && parse_number(what.substr(what.find('=') + 1), nu))
        options.nu_low = options.nu_high = nu;
    }
  const Experiment w = make_experiment(given.bodies, std::move(given.dataset), options);
  progress.reset();
  FitOptions fit_options{w.noise.value, w.floor, true};
  fit_options.starts = search.starts;
  fit_options.seed = search.seed;
  if (arguments.text("--robust") == "huber") fit_options.robust = RobustLoss::kHuber;
  if (arguments.text("--robust") == "tukey") fit_options.robust = RobustLoss::kTukey;
  extend.noise = w.noise.value;
  extend.floor = w.floor;

  const Selection all = all_episodes(w.dataset);
  SearchWatch watch(arguments);
  fit_options.watch = watch.watch();
  FitOptions final_options = fit_options;
  final_options.skip = search.done;
  if (arguments.given("--profile") && fit_options.robust != RobustLoss::kNone)
    fail_usage("--profile and --robust exclude each other",
               "a robust loss is no likelihood: use one of them");
  final_options.profile = arguments.given("--profile");
  const double force_rms = force_error(w.dataset, measured_forces(w.dataset, all)).told();
  ForceError unseen;
  std::string cut_short;  // what a signal ended
  Folds folds;
  Fit result;
  if (plan.automatic) {
    const Improvement improvement =
        improve_step_by_step(arguments, plan, body, options, fit_options, w, force_rms);
    result = improvement.steps.back().fitted;
    unseen = improvement.steps.back().held_out;
    cut_short = improvement.stopped ? "the model was improved" : "";
    folds = make_folds(w.dataset, static_cast<int>(arguments.integer("--folds")));
  } else {
    Starts starts = build(plan, w, all, fit_options, extend);
    require_enough_data(starts.models.front(), w.dataset, all);
    if (plan.start.parameters.empty()) library.add_start(starts.models);
    result = fit_best(starts.models, w, all, final_options, starts.known);
    if (arguments.given("--boundary") && result.converged)
      result = with_refined_boundaries(arguments, result, w, body, fit_options);
  }
  if (result.stopped) return write_unfinished(arguments, plan, w, std::move(result), search);
  if (!result.converged)
    fail_numerics(w.dataset.recording.name, "the fit did not converge: " + result.message,
                  "start from a simpler model, or fix a parameter");
  if (const long count = arguments.integer("--folds");
      count > 1 && !plan.automatic && !watch.interrupted()) {
    folds = make_folds(w.dataset, static_cast<int>(count));
    FitOptions quick = fit_options;
    quick.exact_regions = false;
    quick.starts = 1;
    // Each fold starts from the fit on all data; regions come from the training positions alone,
    // so they are built anew.
    IdentifyPlan refit = plan;
    refit.start = result.model;
    refit.add.clear();
    refit.say = nullptr;
    if (const std::string& map = map_effect().card().name; refit.start.has(map)) {
      remove_effect(refit.start, map);
      refit.add.push_back(map);
    }
    const Linearisation known = w.places.solve(material_of(refit.start));
    unseen = held_out_error(
                 [&](const Selection& training) {
                   return build(refit, w, training, quick, extend, known);
                 },
                 w, folds, quick)
                 .error;
  }
  if (watch.end() && cut_short.empty()) {
    cut_short = "the error on unseen data was found";
    unseen = {};
  }
  const double held_out = unseen.told();
  Model& model = result.model;
  describe_fit(result, plan, w);
  if (!std::isnan(held_out)) model.metadata.set("heldout", format_number(held_out));
  if (!cut_short.empty()) mark_interrupted(model, "while " + cut_short);
  report(arguments, w, result, held_out, folds.by, force_rms);
  rest.tell(result, w);
  Output output(arguments.output());
  write_model(output.stream(), model);
  if (arguments.given("--locations") && cut_short.empty()) {
    Output locations(arguments.text("--locations"));
    write_locations(locations.stream(), fit_locations(model, w, fit_options));
    locations.commit();
  }
  if (arguments.given("--image") && cut_short.empty())
    write_asked_image(arguments, result, w, body);
  library.store(model, [&] { output.commit(); });
  if (arguments.given("--history"))
    add_history(arguments.text("--history"),
                {arguments.output(), effects_label(model), result.error.told(), held_out,
                 w.noise.value, force_rms, static_cast<int>(model.free_parameters().size())});
  if (!cut_short.empty())
    fail_numerics(w.dataset.recording.name, "interrupted while " + cut_short,
                  "the model that was fitted is written: go on from it with --model");
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::identify_specification(), argc, argv, hapsim::run);
}
