// hs-diagnose: which physical effect the model lacks.
#include "base/error.h"
#include "cli/shared_flags.h"
#include "cli/tell.h"
#include "common_options.h"
#include "diagnose/diagnosis_summary.h"
#include "diagnose/diagnosis_table.h"
#include "diagnose/draft_experiment.h"
#include "diagnose/probability.h"
#include "experiment/preparation_flags.h"
#include "fit/fit_words.h"
#include "marked_points.h"
#include "plan/press_plan.h"
#include "recording/torque_columns.h"
#include "thinned.h"

namespace hapsim {
namespace flag {
inline constexpr SwitchFlag check{"--check"}, ignore_torques{"--ignore-torques"};
inline constexpr FileFlag junit{"--junit"}, plan{"--plan"};
inline constexpr IntegerFlag plan_presses{"--plan-presses"}, folds{"--folds"}, flips{"--flips"},
    seed{"--seed"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-diagnose";
  spec.task = Task::kModel;
  spec.summary = "name the physical effect that a model lacks";
  spec.input = "recording CSV (press,t,x,y,z,ux,uy,uz,fx,fy,fz)";
  spec.description = {
      "Layers, inclusions, anisotropy, supports and regions are solved by finite elements on the "
      "coarser of a position's two meshes, and only where some position asks for "
      "another stiffness than the model's; hs-identify takes the finer one. Where there are more "
      "than " +
          std::to_string(kManyPlaces) + " positions, all but regions are settled on " +
          std::to_string(kScreened) +
          " of them first (spread over all, or about the one that departs most), and solved for at "
          "all only where they could be rivals.",
      "Force noise and a gain error by position for mesh and scanned shape (--floor) are taken "
      "into account, so a model is not blamed for them.",
      "Two effects that do equally well are rivals, unless both together leave nothing but noise "
      "and mesh where each alone leaves plainly more: then both are there. Where rivals (up to "
      "three) leave more than noise, the search goes on beside each of them: what else is missing "
      "may tell them apart, and what is found beside all of them is missing whichever it is. More "
      "than three that leave more than noise are no answer: they are possible, and what is left is "
      "told.",
      "Where effects are named and more than noise is left, what all of the given model's misfit "
      "goes with is told beside them, by laws on presses that were left out. Where none of them is "
      "of that kind, and the law does no worse than they do, or they and a law of the rest leave "
      "more than a tenth, they only come near a cause of that kind which has no name here: the "
      "model is unexplained.",
      "Contact points that lie off the body's surface by more than a hundredth of its least extent "
      "are told. Where the forces do not follow the move of the body that would explain them "
      "(shift), the shape is in doubt: the gain error allows for it, and an effect that a wrong "
      "shape looks like is not named alone, but as confused with `shape`.",
      "What acts at one position only, an inclusion or a region, cannot foretell unseen positions; "
      "where it leaves nothing but noise it is judged by unseen presses of the positions, and the "
      "evidence says so.",
      "Effects are tried by their forces alone. Where torques of the tool were measured (columns "
      "as "
      "in hs-identify(1)) they judge what was found: a model that explains the forces and leaves "
      "more of the torques than their noise and the levers' errors (1.15 times, 1.3 where their "
      "noise was measured from the data), or that has the torques at the price of the forces, is "
      "unexplained, and it is said whether the tool seems to touch at another point than it is "
      "said to. No effect is named by torques.",
      "Marked points of the surface (--markers, as in hs-identify(1)) judge what was found as "
      "torques do: a model that explains the forces and leaves more of the points than their noise "
      "and the meshes (1.15 times; 1.3 where their noise was measured from the data; more where "
      "few points leave it to chance), or that has the points at the price of the forces, is "
      "unexplained, and the worst point is named. No effect is named by points. For what the model "
      "does not say "
      "of points a line says why.",
      "A common gain of the force sensor cannot be told from Young's modulus by any recording: "
      "check the sensor with a calibration weight."};
  const std::vector<std::string> gates = gates_in_words();
  spec.description.insert(spec.description.begin(), gates.begin(), gates.end());
  spec.options = experiment_flags();
  const std::vector<Option> own{
      {.flag = flag::model,
       .value = "FILE",
       .help = "Model from hs-identify.",
       .group = "Input",
       .required = true},
      {.flag = flag::check,
       .help = "Exit code 1 when the model is not complete; with -q that is all it says.",
       .group = "Output"},
      {.flag = flag::json,
       .value = "FILE",
       .help = "Also writes the diagnosis as JSON.",
       .group = "Output",
       .writes = {"json"}},
      {.flag = flag::junit,
       .value = "FILE",
       .help = "Also writes the verdict as JUnit's XML, a test each effect that could be tested.",
       .group = "Output",
       .writes = {"xml"}},
      {.flag = flag::plan,
       .value = "FILE",
       .help = "Writes the motion (CSV, without forces) of the next presses to record: those that "
               "best tell indistinguishable effects apart, or determine the least certain "
               "parameter; at pressed positions, and between them where the effects differ there.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::plan_presses,
       .value = "N",
       .help = "Number of presses of the plan.",
       .group = "Output",
       .default_text = "3",
       .minimum = 1,
       .maximum = 100},
      {.flag = flag::folds,
       .value = "N",
       .help = "Parts in which positions are held out.",
       .group = "Diagnosis",
       .default_text = "6",
       .minimum = 2,
       .maximum = 1000},
      {.flag = flag::flips,
       .value = "N",
       .help = "Random sign flips of presses behind the false-alarm chance.",
       .group = "Diagnosis",
       .default_text = "999",
       .minimum = 99,
       .maximum = 1000000},
      {.flag = flag::ignore_torques,
       .help = "Leaves measured torques of the tool (tqx,tqy,tqz) out.",
       .group = "Input"},
      markers_option("Displacements of marked points of the surface, seen while the tool presses."),
      {.flag = flag::seed,
       .value = "N",
       .help = "Seed of the flips.",
       .group = "Diagnosis",
       .default_text = "1",
       .minimum = 0},
      most_rows_flag("60000")};
  spec.options.insert(spec.options.end(), own.begin(), own.end());
  spec.tables = {
      {"Diagnosis (output)",
       {{"rank", "0: the model as a whole; then the effects, best first"},
        {"effect", "name in the catalogue; 'model' in the first row"},
        {"verdict",
         "missing, possible, indistinguishable, absent, not testable; of the model: "
         "complete, incomplete, ambiguous, unexplained"},
        {"rmse_now, rmse_after", "error without and with the effect [N]"},
        {"heldout_now, heldout_after",
         "the same on positions left out of the fit; of fewer than " +
             std::to_string(kLeastPresses) +
             " presses on the rest of each, learned from its first part, and on presses left out "
             "(the metadata heldout_by says which) [N]; after only for effects that pass the other "
             "tests"},
        {"p_value", "chance of a false alarm, all effects tried counted"},
        {"probability", probability_in_words()},
        {"confused_with", "effects that do as well, separated by spaces; `shape`: a wrong body"},
        {"where", "where and when it acts"},
        {"evidence", "share of the misfit, fitted size, smallest size that would show"},
        {"next_measurement", "what would tell it from its rivals"},
        {"command", "the command that adds it"}}}};
  spec.examples = {
      {"hs-diagnose data.csv --body body.ply --model m0.csv -o effects.csv", "What is missing."},
      {"hs-diagnose data.csv --body body.ply --model m0.csv --plan next.csv -o effects.csv",
       "And what to measure next."},
      {"hs-diagnose data.csv --body body.ply --model m0.csv --check -q", "A check in CI."}};
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-effects(7)"};
  return spec;
}

void write_plan(const Arguments& arguments, const Diagnosis& d, const Experiment& w) {
  const MeasurementPlan plan =
      plan_presses(d.rivals, w, static_cast<std::size_t>(arguments[flag::plan_presses]));
  Output output(arguments[flag::plan]);
  write_recording(output.stream(), plan.motion);
  output.commit();
  for (const std::string& line : plan_lines(plan, arguments[flag::plan]))
    say(arguments, "hs-diagnose", line);
}

DiagnosedFiles files_of(const Arguments& arguments) {
  DiagnosedFiles files{arguments.input(), arguments[flag::body], arguments[flag::model]};
  files.flags = repeated_flags(arguments) + calibration_words(arguments);
  if (arguments.output() != "-") files.output = arguments.output();
  return files;
}

int run(const Arguments& arguments) {
  const Model model = load_model(arguments, "hs-diagnose");
  std::vector<Vec3> window;
  const TetMesh body = load_body(arguments, &window);
  say_idle(arguments, "hs-diagnose", model, body);
  std::shared_ptr<Progress> progress;
  ExperimentOptions options = experiment_options(arguments, progress);
  std::vector<Recording> recording =
      load_thinned(arguments, "hs-diagnose", {arguments.input()}, options);
  if (arguments[flag::ignore_torques]) forget_torques(recording.front());
  const std::optional<MarkerTable> marker_table = asked_markers(arguments);
  const Experiment w = draft_experiment(body, window, model, std::move(recording.front()), options);
  progress.reset();
  for (const std::string& words : left_out_words(w)) say(arguments, "hs-diagnose", words);
  for (const std::string& known : known_words(model, w.dataset))
    say(arguments, "hs-diagnose", known);
  const std::optional<Markers> markers = matched(arguments, "hs-diagnose", marker_table, w);
  DiagnoseOptions diagnose_options;
  diagnose_options.markers = markers ? &*markers : nullptr;
  diagnose_options.folds = static_cast<int>(arguments[flag::folds]);
  diagnose_options.flips = static_cast<int>(arguments[flag::flips]);
  diagnose_options.seed = static_cast<std::uint64_t>(arguments[flag::seed]);
  auto testing = std::make_unique<Progress>(arguments, "", 0);
  testing->show("fitting the model");
  diagnose_options.progress = [&](const std::string& what, std::size_t k, std::size_t n) {
    testing->show(what, k, n);
  };
  const Diagnosis d = diagnose(model, w, w.allowance(), diagnose_options);
  testing.reset();

  const DiagnosedFiles files = files_of(arguments);
  if (result_is_wanted(arguments)) {
    Output output(arguments.output());
    write_diagnosis(output.stream(), d, files, arguments.text(flag::seed));
    output.commit();
  }
  if (arguments.given(flag::json)) {
    Output json(arguments[flag::json]);
    json.stream() << diagnosis_json(d, files);
    json.commit();
  }
  if (arguments.given(flag::junit)) {
    Output junit(arguments[flag::junit]);
    write_junit(junit.stream(), "hs-diagnose", diagnosis_cases(d));
    junit.commit();
  }
  if (arguments.verbose())
    for (const std::string& line : diagnosis_lines(d, files)) say(arguments, line);
  if (arguments.given(flag::plan)) write_plan(arguments, d, w);
  say_summary(arguments, diagnosis_summary(d, files, arguments.text(flag::plan)));
  const bool failed = arguments[flag::check] && d.verdict != ModelVerdict::kComplete;
  return static_cast<int>(failed ? ExitCode::kCheckFailed : ExitCode::kDone);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
