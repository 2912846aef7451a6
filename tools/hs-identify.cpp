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
#include "identify_acfm.h"
#include "identify_boundary.h"
#include "identify_follow.h"
#include "identify_image.h"
#include "identify_library.h"
#include "identify_plan.h"
#include "identify_recordings.h"
#include "identify_report.h"
#include "identify_search.h"
#include "identify_specification.h"
#include "identify_until.h"
#include "model/model_edit.h"
#include "model/model_history.h"

namespace hapsim {
namespace {

std::string words_of(const TermChoice& choice, const std::string& effect, double per_measured) {
  std::string trials;
  for (const TermTrial& t : choice.trials)
    trials += fmt::format(
        "{}{}: error {:.4g} N{}", trials.empty() ? "" : "; ", t.terms, per_measured * t.rmse,
        std::isnan(t.held_out) ? "" : fmt::format(", unseen {:.4g} N", per_measured * t.held_out));
  return fmt::format("{} of {} chosen ({})", counted(choice.terms, "term", "terms"), effect,
                     trials);
}

// Models to fit on the chosen episodes: fitted step by step, one effect after the other.
std::vector<Model> build(const Plan& plan, const Workspace& w, const Selection& selection,
                         const FitOptions& fit_options, const ExtendOptions& extend) {
  Model model = plan.start;
  if (model.parameters.empty()) {
    model = elastic_model(w.dataset, selection, *w.body);
    for (const std::string& what : plan.fix)
      if (what.find("nu") != std::string::npos) set_state(model, what, ParameterState::kFixed);
  }
  std::vector<Model> starts{model};
  for (std::size_t k = 0; k < plan.add.size(); ++k) {
    FitOptions quick = fit_options;
    quick.exact_regions = false;
    quick.starts = 1;  // the last fit searches
    const Model base = fit_best(starts, w.dataset, selection, *w.body, quick).model;
    const EffectCard& card = require_effect(plan.add[k]).card();
    const bool terms = card.terms && !card.from_locations;
    FitOptions searching = quick;
    searching.starts = fit_options.starts;
    ExtendOptions own = extend;
    if (terms && plan.terms.automatic) {
      const TermChoice choice = choose_terms(base, plan.add[k], plan.terms.count, w.dataset,
                                             selection, *w.body, searching, extend);
      own.terms = choice.terms;
      if (plan.say) plan.say(words_of(choice, plan.add[k], per_measured_component(w.dataset)));
    }
    starts = with_effect(base, plan.add[k], w.dataset, selection, *w.body, own);
    if (terms && !plan.terms.windows.empty())
      for (Model& start : starts) set_windows(start, plan.add[k], plan.terms.windows);
  }
  for (Model& start : starts)
    for (const std::string& what : plan.fix) set_state(start, what, ParameterState::kFixed);
  return starts;
}

// Adds what a diagnosis finds missing, step by step; each step goes into the history.
Improvement improve_step_by_step(const Arguments& arguments, const Plan& plan, const TetMesh& body,
                                 WorkspaceOptions options, const FitOptions& fit_options,
                                 Workspace& w, double force_rms) {
  options.draft = true;
  options.progress = nullptr;
  Workspace draft = make_workspace(body, w.dataset.recording, options);
  ImproveOptions improve_options;
  improve_options.fit = fit_options;
  improve_options.diagnose.folds = static_cast<int>(arguments.integer("--folds"));
  improve_options.diagnose.seed = fit_options.seed;
  improve_options.progress = [&](const std::string& what) {
    if (arguments.verbose()) say(arguments, "hs-identify", what);
  };
  Model start = plan.start;
  if (start.parameters.empty()) {
    start = elastic_model(w.dataset, all_episodes(w.dataset), *w.body);
    for (const std::string& what : plan.fix) set_state(start, what, ParameterState::kFixed);
  }
  Improvement improvement = improve(start, w, draft, improve_options);
  for (std::size_t k = 0; k < improvement.steps.size(); ++k) {
    const ImprovementStep& step = improvement.steps[k];
    const std::string label = effects_label(step.fitted.model);
    const double per_measured = per_measured_component(w.dataset);
    const double rmse = per_measured * step.fitted.rmse, held_out = per_measured * step.held_out;
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

void describe_fit(Model& model, const Plan& plan, const Workspace& w, double rmse) {
  model.metadata = plan.start.metadata;
  unmark(model);
  for (const char* key : {"heldout", "until", "heldout_later"}) model.metadata.remove(key);
  model.metadata.set("rmse", format_number(rmse));
  model.metadata.set("force_noise", format_number(w.noise.value));
  if (w.dataset.tools() > 1)
    model.metadata.remove("tool_radius");
  else
    model.metadata.set("tool_radius", format_number(w.dataset.setups.front().tool_radius));
}

// The best so far of a fit that a signal ended, marked.
int write_unfinished(const Arguments& arguments, const Plan& plan, const Workspace& w,
                     FitResult result, const SearchState& search) {
  SearchState state = search;
  state.done = result.starts_done;
  result.rmse *= per_measured_component(w.dataset);
  describe_fit(result.model, plan, w, result.rmse);
  mark_unfinished(result.model, state);
  Output output(arguments.output());
  write_model(output.stream(), result.model);
  output.commit();
  fail_numerics(
      w.dataset.recording.name,
      fmt::format(
          "the fit was interrupted{}; the best so far, error {:.4g} N, is written",
          state.starts > 1 ? fmt::format(" after {} of {} starts", state.done, state.starts) : "",
          result.rmse),
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
  const Plan plan = make_plan(arguments);
  ExtendOptions extend;
  extend.regions = regions_asked(arguments.text("--regions"));
  extend.terms = plan.terms.count;
  const SearchState search = search_asked(arguments, plan.start);
  Experiment experiment = load_experiment(arguments);
  require_fit_for(arguments, plan, experiment);
  Later later(arguments, experiment);
  const TetMesh& body = experiment.bodies.front();
  IdentifyLibrary library(arguments, experiment.recording, body);
  std::shared_ptr<Progress> progress;
  WorkspaceOptions options = workspace_options(arguments, progress);
  set_poisson_range(plan.start, options);
  if (plan.start.parameters.empty())
    for (const std::string& what : plan.fix) {
      const bool is_nu = what.rfind("nu=", 0) == 0 || what.rfind("elastic.nu=", 0) == 0;
      double nu = 0;
      if (is_nu && parse_number(what.substr(what.find('=') + 1), nu))
        options.nu_low = options.nu_high = nu;
    }
  Workspace w = make_workspace(experiment.bodies, std::move(experiment.recording),
                               experiment.setup_of_row, options);
  progress.reset();
  FitOptions fit_options{w.noise.value, w.floor, true};
  fit_options.starts = search.starts;
  fit_options.seed = search.seed;
  if (arguments.text("--robust") == "huber") fit_options.robust = RobustLoss::kHuber;
  if (arguments.text("--robust") == "tukey") fit_options.robust = RobustLoss::kTukey;
  extend.noise = w.noise.value;
  extend.floor = w.floor;

  const Selection all = all_episodes(w.dataset);
  const double per_measured = per_measured_component(w.dataset);
  SearchWatch watch(arguments);
  fit_options.watch = watch.watch();
  FitOptions final_options = fit_options;
  final_options.skip = search.done;
  if (arguments.given("--profile") && fit_options.robust != RobustLoss::kNone)
    fail_usage("--profile and --robust exclude each other",
               "a robust loss is no likelihood: use one of them");
  final_options.profile = arguments.given("--profile");
  const double force_rms = std::sqrt(measured_forces(w.dataset, all).squaredNorm() /
                                     (3.0 * static_cast<double>(w.dataset.rows()))) *
                           per_measured;
  double held_out = std::nan("");
  std::string cut_short;  // what a signal ended
  Folds folds;
  FitResult result;
  if (plan.automatic) {
    const Improvement improvement =
        improve_step_by_step(arguments, plan, body, options, fit_options, w, force_rms);
    result = improvement.steps.back().fitted;
    held_out = improvement.steps.back().held_out;
    cut_short = improvement.stopped ? "the model was improved" : "";
    folds = make_folds(w.dataset, static_cast<int>(arguments.integer("--folds")));
  } else {
    std::vector<Model> starts = build(plan, w, all, fit_options, extend);
    require_enough_data(starts.front(), w.dataset, all);
    if (plan.start.parameters.empty()) library.add_start(starts);
    result = fit_best(starts, w.dataset, all, *w.body, final_options);
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
    Plan refit = plan;
    refit.start = result.model;
    refit.add.clear();
    refit.say = nullptr;
    if (refit.start.has("regions")) {
      remove_effect(refit.start, "regions");
      refit.add.push_back("regions");
    }
    held_out =
        held_out_error(
            [&](const Selection& training) { return build(refit, w, training, quick, extend); },
            w.dataset, folds, *w.body, quick)
            .rmse;
  }
  if (watch.end() && cut_short.empty()) {
    cut_short = "the error on unseen data was found";
    held_out = std::nan("");
  }
  result.rmse *= per_measured;
  held_out *= per_measured;
  Model& model = result.model;
  describe_fit(model, plan, w, result.rmse);
  if (!std::isnan(held_out)) model.metadata.set("heldout", format_number(held_out));
  if (!cut_short.empty()) mark_interrupted(model, "while " + cut_short);
  report(arguments, w, result, held_out, folds.by, force_rms);
  later.tell(model, w);
  Output output(arguments.output());
  write_model(output.stream(), model);
  if (arguments.given("--locations") && cut_short.empty()) {
    Output locations(arguments.text("--locations"));
    write_locations(locations.stream(), fit_locations(model, w.dataset, *w.body, fit_options));
    locations.commit();
  }
  if (arguments.given("--image") && cut_short.empty()) write_asked_image(arguments, model, w, body);
  library.store(model, [&] { output.commit(); });
  if (arguments.given("--history"))
    add_history(arguments.text("--history"),
                {arguments.output(), effects_label(model), result.rmse, held_out, w.noise.value,
                 force_rms, static_cast<int>(model.free_parameters().size())});
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
