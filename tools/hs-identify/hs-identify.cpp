// hs-identify: the material and sensor parameters that explain a recording.
#include <fmt/format.h>

#include <algorithm>

#include "answer.h"
#include "base/blas.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "common_options.h"
#include "experiment/learned_curves.h"
#include "fit/constraint_regions.h"
#include "fit/constraints.h"
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
#include "identify/identify.h"
#include "marked_points.h"
#include "model/model_edit.h"
#include "model/model_history.h"

namespace hapsim {
namespace {

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
  FitRequest plan = asked_fit(arguments);
  if (arguments.given(flag::region_names)) {
    region_names(arguments[flag::region_names], flag::region_names.name);  // refused at once
    plan.start.metadata.set("region_names", arguments[flag::region_names]);
  }
  IdentifyRequest request;
  request.fit = plan;
  request.regions = parse_regions(arguments[flag::regions], flag::regions.name);
  const std::vector<Relation> constraints =
      parse_constraints(arguments.list(flag::constrain), flag::constrain.name);
  const SearchState search = search_asked(arguments, plan.start);
  std::shared_ptr<Progress> progress;
  ExperimentOptions options = experiment_options(arguments, progress);
  GivenRecordings given = load_recordings(arguments, plan.start, options);
  require_fit_for(arguments, plan, given.dataset);
  say_together(arguments, "hs-identify", given.dataset.recording);
  const std::optional<MarkerTable> marker_table = asked_markers(arguments);
  if (marker_table && arguments.given(flag::data))
    fail_usage("--markers is of one recording", "fit each recording by itself, or without points");
  RestOfPress rest(arguments, given);
  const TetMesh& body = given.bodies.front();
  for (const std::string& words : doubts_of(plan.start, given.bodies))
    say(arguments, "hs-identify", words);
  const std::unique_ptr<LibraryUse> library =
      asked_library(arguments, given.dataset.recording, body);
  set_poisson_range(plan, options);
  options.windows = given.windows;
  const Experiment w = make_experiment(given.bodies, std::move(given.dataset), options);
  progress.reset();
  for (const std::string& words : left_out_words(w)) say(arguments, "hs-identify", words);
  const std::optional<Markers> markers = matched(arguments, "hs-identify", marker_table, w);
  FitOptions& fit_options = request.options;
  fit_options.markers = markers ? &*markers : nullptr;
  fit_options.starts = search.starts;
  fit_options.seed = search.seed;
  fit_options.skip = search.done;
  fit_options.robust = robust_loss(arguments[flag::robust]);
  fit_options.profile = arguments[flag::profile];
  fit_options.constraints = constraints;
  request.folds = static_cast<int>(arguments[flag::folds]);

  SearchWatch watch(arguments);
  fit_options.watch = watch.watch();
  fit_options.keep = watch.keep();
  SavedSearch saved(arguments, search, plan.start.metadata);
  fit_options.after_start = [&](const Model& best, int done) { saved.keep(best, done); };
  request.say = plan.say;
  request.tell = [&](const std::string& what) {
    watch.show(what);
    if (arguments.verbose()) say(arguments, "hs-identify", what);
  };
  request.progress = [&](const std::string& what, std::size_t k, std::size_t n) {
    watch.show(what, k, n);
  };
  request.starts = [&](std::vector<Model>& starts) {
    if (library && plan.start.parameters.empty()) library->add_start(starts);
    const std::string& field = field_effect().card().name;
    if (arguments.given(flag::field) && !starts.front().has(field))
      fail_usage("--field is of " + field + ", which this model has not", "add --add " + field);
    if (arguments.given(flag::curves) && learned_curves(starts.front()).empty())
      fail_usage(
          "--curves is of learned effects, and this model has none",
          "add --add learned-depth, learned-kernel, learned-axes, learned-gain or learned-drift");
  };
  if (arguments.given(flag::boundary))
    request.refine = [&](const Fit& fitted) {
      return with_refined_boundaries(arguments, fitted, w, body, each_fit(request, w));
    };
  request.step = [&](const ImprovementStep& step, const std::string& by, double force_rms) {
    if (arguments.given(flag::history))
      add_history(arguments[flag::history],
                  history_row(arguments.output() + ": " + effects_label(step.fitted.model),
                              step.fitted, step.held_out.told(), by, w.noise.value, force_rms));
  };
  request.interrupted = [&] { return watch.interrupted(); };
  request.end = [&] { return watch.end(); };
  Identification found = identify(request, body, w, options);
  Fit& result = found.fitted;
  if (result.stopped) return write_unfinished(arguments, plan, w, std::move(result), search, saved);
  const Model& model = result.model;
  const std::string& cut_short = found.cut_short;
  Summary summary = identification_summary(found, w);
  if (arguments.verbose()) say(arguments, "hs-identify", "BLAS: " + blas_name());
  if (const std::string later = rest.tell(result, w); !later.empty())
    summary.notes.push_back(later);
  Output output(result_file(arguments));
  write_model(output.stream(), model);
  if (arguments.given(flag::locations) && cut_short.empty()) {
    Output locations(arguments[flag::locations]);
    write_locations(locations.stream(), fit_locations(model, w, each_fit(request, w)));
    locations.commit();
  }
  if (arguments.given(flag::field) && cut_short.empty() && learns_field(model)) {
    Output field(arguments[flag::field]);
    write_field(field.stream(), place_field(model), w.places.setup(0)->surface());
    field.commit();
  }
  if (arguments.given(flag::curves) && cut_short.empty() && !learned_curves(model).empty()) {
    Output curves(arguments[flag::curves]);
    write_curves(curves.stream(), model);
    curves.commit();
  }
  if ((arguments.given(flag::image) || arguments.given(flag::lumps)) && cut_short.empty())
    write_asked_image(arguments, result, w, body);
  if (library)
    library->store(model, [&] { output.commit(); });
  else
    output.commit();
  saved.finish();
  if (arguments.given(flag::history))
    add_history(arguments[flag::history],
                history_row(arguments.output(), result, found.unseen, found.unseen_by,
                            w.noise.value, found.force_rms));
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
