// hs-identify: the material and sensor parameters that explain a recording.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "answer.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "common_options.h"
#include "diagnose/improve.h"
#include "diagnose/wording.h"
#include "experiment/plausible.h"
#include "fit/fit_record.h"
#include "fit/fit_request.h"
#include "fit/fit_words.h"
#include "fit/learned_field.h"
#include "fit/location_fit.h"
#include "hs-identify/acfm.h"
#include "hs-identify/boundary.h"
#include "hs-identify/flags.h"
#include "hs-identify/follow.h"
#include "hs-identify/image.h"
#include "hs-identify/library.h"
#include "hs-identify/plan.h"
#include "hs-identify/recordings.h"
#include "hs-identify/search.h"
#include "hs-identify/specification.h"
#include "hs-identify/until.h"
#include "linalg/blas.h"
#include "model/model_edit.h"
#include "model/model_history.h"

namespace hapsim {
namespace {

// Adds what a diagnosis finds missing, step by step; each step goes into the history.
Improvement improve_step_by_step(const Arguments& arguments, const FitRequest& plan,
                                 const TetMesh& body, ExperimentOptions options,
                                 const FitOptions& fit_options, const Experiment& w,
                                 double force_rms, SearchWatch& watch) {
  options.draft = true;
  options.progress = nullptr;
  const Experiment draft = make_experiment(std::span(&body, 1), w.dataset, options);
  ImproveOptions improve_options;
  improve_options.fit = fit_options;
  improve_options.diagnose.folds = static_cast<int>(arguments[flag::folds]);
  improve_options.diagnose.seed = fit_options.seed;
  improve_options.progress = [&](const std::string& what) {
    watch.show(what);
    if (arguments.verbose()) say(arguments, "hs-identify", what);
  };
  improve_options.diagnose.progress = [&](const std::string& what, std::size_t k, std::size_t n) {
    watch.show(what, k, n);
  };
  Model start = plan.start;
  if (start.parameters.empty()) {
    start = elastic_model(w, all_episodes(w.dataset));
    for (const std::string& what : plan.fix) set_state(start, what, ParameterState::kFixed);
  }
  Improvement improvement = improve(start, w, draft, improve_options);
  for (std::size_t k = 0; k < improvement.steps.size(); ++k) {
    const ImprovementStep& step = improvement.steps[k];
    say(arguments, "hs-identify", step_words(step, w.noise.value));
    // The last step is the model itself, which run() writes down.
    if (arguments.given(flag::history) && k + 1 < improvement.steps.size())
      add_history(arguments[flag::history],
                  history_row(arguments.output() + ": " + effects_label(step.fitted.model),
                              step.fitted, step.held_out.told(), w.noise.value, force_rms));
  }
  return improvement;
}

// The best so far of a fit that a signal ended, marked.
int write_unfinished(const Arguments& arguments, const FitRequest& plan, const Experiment& w,
                     Fit result, const SearchState& search, const SavedSearch& saved) {
  SearchState state = search;
  state.done = result.starts_done;
  record_fit(result, plan.start.metadata, w);
  mark_unfinished(result.model, state);
  Output output(result_file(arguments));
  write_model(output.stream(), result.model);
  output.commit();
  saved.finish();
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
  for (const Option& option : follow_flags()) known.push_back(option.name());
  for (const Option& option : identify_specification().options)
    if (arguments.given(option.flag) &&
        std::find(known.begin(), known.end(), option.name()) == known.end())
      fail_usage(option.flag + " is of recordings, and --follow reads a stream",
                 "leave one of them out");
  if (arguments.list(flag::body).size() > 1)
    fail_usage("--follow is for one body", "give --body once");
}

// A diagnosis of the model, or its use where the diagnosis is done; "" where there is no file of
// it.
std::string next_command(const Arguments& arguments, const FitRequest& plan) {
  if (arguments.output() == "-" || arguments.input() == "-" || arguments.given(flag::data))
    return "";
  return fmt::format("{} {} --body {} --model {}{}{}",
                     plan.automatic ? "hs-simulate" : "hs-diagnose",
                     shell_quoted(arguments.input()), shell_quoted(arguments.list(flag::body)[0]),
                     shell_quoted(arguments.output()), calibration_words(arguments),
                     plan.automatic ? " -o forces.csv" : " -o effects.csv");
}

int run(const Arguments& arguments) {
  if (arguments[flag::follow]) {
    refuse_other_flags(arguments);
    return run_follow(arguments);
  }
  for (const Option& option : follow_flags())
    if (arguments.given(option.flag))
      fail_usage(option.flag + " is of a stream", "add --follow, or leave it out");
  if (arguments.given(flag::acfm)) return run_acfm(arguments);
  if (arguments[flag::stiffening])
    fail_usage("--stiffening is of analytical models", "add --acfm N, or --add hyperelastic");
  const FitRequest plan = asked_fit(arguments);
  ExtendOptions extend;
  extend.regions = parse_regions(arguments[flag::regions], flag::regions.name);
  extend.terms = plan.terms.count;
  const SearchState search = search_asked(arguments, plan.start);
  GivenRecordings given = load_recordings(arguments, plan.start);
  require_fit_for(arguments, plan, given.dataset);
  say_together(arguments, "hs-identify", given.dataset.recording);
  RestOfPress rest(arguments, given);
  const TetMesh& body = given.bodies.front();
  const std::unique_ptr<LibraryUse> library =
      asked_library(arguments, given.dataset.recording, body);
  std::shared_ptr<Progress> progress;
  ExperimentOptions options = experiment_options(arguments, progress);
  set_poisson_range(plan, options);
  options.windows = given.windows;
  const Experiment w = make_experiment(given.bodies, std::move(given.dataset), options);
  progress.reset();
  for (const std::string& words : left_out_words(w)) say(arguments, "hs-identify", words);
  FitOptions fit_options{w.noise.value, w.floor, true};
  fit_options.starts = search.starts;
  fit_options.seed = search.seed;
  if (arguments[flag::robust] == "huber") fit_options.robust = RobustLoss::kHuber;
  if (arguments[flag::robust] == "tukey") fit_options.robust = RobustLoss::kTukey;
  extend.noise = w.noise.value;
  extend.floor = w.floor;

  const Selection all = all_episodes(w.dataset);
  SearchWatch watch(arguments);
  fit_options.watch = watch.watch();
  fit_options.keep = watch.keep();
  FitOptions final_options = fit_options;
  final_options.skip = search.done;
  SavedSearch saved(arguments, search, plan.start.metadata);
  final_options.after_start = [&](const Model& best, int done) { saved.keep(best, done); };
  if (arguments[flag::profile] && fit_options.robust != RobustLoss::kNone)
    fail_usage("--profile and --robust exclude each other",
               "a robust loss is no likelihood: use one of them");
  final_options.profile = arguments[flag::profile];
  const double force_rms = force_error(w.dataset, measured_forces(w.dataset, all)).told();
  ForceError unseen;
  std::string cut_short;  // what a signal ended
  std::string ended;      // why it was not improved further
  Folds folds;
  Fit result;
  if (plan.automatic) {
    const Improvement improvement =
        improve_step_by_step(arguments, plan, body, options, fit_options, w, force_rms, watch);
    result = improvement.steps.back().fitted;
    unseen = improvement.steps.back().held_out;
    if (improvement.stopped)
      cut_short = "the model was improved";
    else
      ended = end_words(improvement);
    folds.by = improvement.unseen;
  } else {
    Starts starts = build_starts(plan, w, all, fit_options, extend);
    require_enough_data(starts.models.front(), w.dataset, all);
    if (library && plan.start.parameters.empty()) library->add_start(starts.models);
    const std::string& field = field_effect().card().name;
    if (arguments.given(flag::field) && !starts.models.front().has(field))
      fail_usage("--field is of " + field + ", which this model has not", "add --add " + field);
    result = fit_best(starts.models, w, all, final_options, starts.known);
    if (arguments.given(flag::boundary) && result.converged)
      result = with_refined_boundaries(arguments, result, w, body, fit_options);
  }
  if (result.stopped) return write_unfinished(arguments, plan, w, std::move(result), search, saved);
  if (!result.converged)
    fail_numerics(w.dataset.recording.name, "the fit did not converge: " + result.message,
                  "start from a simpler model, or fix a parameter");
  if (const long count = arguments[flag::folds];
      count > 1 && !plan.automatic && !watch.interrupted()) {
    folds = make_folds(w.dataset, static_cast<int>(count));
    unseen = held_out_error(plan, result.model, w, folds, fit_options, extend);
  }
  if (watch.end() && cut_short.empty()) {
    cut_short = "the error on unseen data was found";
    unseen = {};
  }
  const double held_out = unseen.told();
  Model& model = result.model;
  record_fit(result, plan.start.metadata, w);
  if (!std::isnan(held_out)) {
    model.metadata.set("heldout", format_number(held_out));
    model.metadata.set("heldout_by", folds.by);
  }
  if (!cut_short.empty()) mark_interrupted(model, "while " + cut_short);
  Summary summary = fit_summary(w, result, held_out, folds.by, force_rms);
  if (!ended.empty()) summary.notes.insert(summary.notes.begin(), ended);
  if (arguments.verbose()) say(arguments, "hs-identify", "BLAS: " + blas_name());
  if (const std::string later = rest.tell(result, w); !later.empty())
    summary.notes.push_back(later);
  Output output(result_file(arguments));
  write_model(output.stream(), model);
  if (arguments.given(flag::locations) && cut_short.empty()) {
    Output locations(arguments[flag::locations]);
    write_locations(locations.stream(), fit_locations(model, w, fit_options));
    locations.commit();
  }
  if (arguments.given(flag::field) && cut_short.empty() && learns_field(model)) {
    Output field(arguments[flag::field]);
    write_field(field.stream(), place_field(model), w.places.setup(0)->surface());
    field.commit();
  }
  if (arguments.given(flag::image) && cut_short.empty())
    write_asked_image(arguments, result, w, body);
  if (library)
    library->store(model, [&] { output.commit(); });
  else
    output.commit();
  saved.finish();
  if (arguments.given(flag::history))
    add_history(arguments[flag::history],
                history_row(arguments.output(), result, held_out, w.noise.value, force_rms));
  if (cut_short.empty()) summary.next = next_command(arguments, plan);
  tell_answer(arguments, summary);
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
