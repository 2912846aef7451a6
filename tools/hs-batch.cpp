// hs-batch: many recordings by one manifest; make does the work.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>

#include "answer.h"
#include "base/error.h"
#include "batch/batch_report.h"
#include "batch/batch_summary.h"
#include "batch/rules.h"
#include "io/number.h"

namespace hapsim {
namespace flag {
inline constexpr TextFlag out{"--out"}, bin{"--bin"};
inline constexpr SwitchFlag prepare{"--prepare"}, wait{"--wait"};
inline constexpr ChoiceFlag stages{"--stages"};
inline constexpr FileFlag html{"--html"}, junit{"--junit"}, writes{"--writes"};
inline constexpr TimeFlag step_time{"--step-time"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-batch";
  spec.task = Task::kMany;
  spec.summary = "identify and diagnose many recordings by one manifest";
  spec.input = "manifest CSV, a row a recording";
  spec.description = {
      "With --prepare it checks the manifest and writes rules for make, one chain of files for "
      "each "
      "recording; without, it reads how far they have come and writes the summary. In between make "
      "does the work, which `make -f Makefile.pipeline batch MANIFEST=... -jN` puts together. A "
      "file "
      "is made again only when its command, its inputs or hapsim's version has changed, so what "
      "was "
      "interrupted goes on where it was. One failure never stops the others, and is not tried "
      "again "
      "until something that it depends on has changed, unless it was a failure of the machine "
      "(full "
      "disk, out of memory).",
      "Each step runs with one thread; -j of make says how many run side by side, and bounds the "
      "memory.",
      "On a cluster: DIR/targets lists the recordings, and `sbatch --array=1-N DIR/array.sh` makes "
      "them "
      "as a job array of Slurm (Makefile.pipeline does so with CLUSTER=slurm); any other engine "
      "that "
      "runs `make -C DIR -f batch.mk TARGET` on a shared file system does as well.",
      "A manifest is taken for somebody else's words. Its names and options run nothing, files "
      "that "
      "its options write go to DIR/recordings/NAME/files and nowhere else (the steps run with "
      "HAPSIM_WRITES, the names of what may be written), inputs are plain files, a step that does "
      "not end is ended, and a text that a spreadsheet would take for a formula stands in the "
      "summary behind an apostrophe.",
      "Exit code 1 when a recording failed or was not run. Each failed recording is told in a line "
      "of its own."};
  spec.options = {
      {.flag = flag::out,
       .value = "DIR",
       .help = "Where everything is made: bodies/..., recordings/NAME/model.csv, effects.csv, "
               "forces.csv, report.html, and what each step said in STEP.log.",
       .default_text = "batch"},
      {.flag = flag::prepare,
       .help = "Write DIR/batch.mk for `make -k -C DIR -f batch.mk`, and no summary."},
      {.flag = flag::stages,
       .value = "LAST",
       .help = "How far each recording goes: its model, also its diagnosis, also its report.",
       .default_text = "report",
       .choices = {"model", "diagnosis", "report"}},
      {.flag = flag::bin, .value = "DIR", .help = "Where the other tools are, before the PATH."},
      {.flag = flag::step_time,
       .value = "S",
       .help =
           "In which each step has to end [s]; after that it has failed, and is tried again when "
           "the batch is.",
       .default_text = "21600",
       .minimum = 0.1,
       .maximum = 1e7},
      {.flag = flag::writes,
       .value = "DIR",
       .help = "A folder where the manifest's options may write as well, and make a --library. "
               "Otherwise they write only below DIR/recordings/NAME/files.",
       .repeatable = true},
      {.flag = flag::wait,
       .help =
           "Read make's output from standard input until it ends, show progress, then write the "
           "summary."},
      {.flag = flag::html,
       .value = "FILE",
       .help = "Also writes an overview: recordings by error, verdicts, failures with the command "
               "that repeats them.",
       .writes = {"html", "htm"}},
      {.flag = flag::junit,
       .value = "FILE",
       .help = "Also writes JUnit's XML, a test a recording, for CI servers.",
       .writes = {"xml"}}};
  spec.options.push_back(answer_option());
  spec.tables = {
      {"Manifest (input)",
       {{"name", "name of the recording, any text, no two alike"},
        {"data", "its recording CSV; paths are relative to the manifest's folder; or"},
        {"raw",
         "a table of another machine, which hs-import makes into data; body and scan may then be "
         "empty when import_options state a --block"},
        {"body", "body from hs-tetmesh; or"},
        {"scan", "its scan, of which the body is made (once for rows with equal scan and options)"},
        {"tool", "radius of the tool, 0.004 [m] or 4mm; empty: as the recording says"},
        {"effects", "as hs-identify --effects: elastic (when empty), 'elastic viscoelastic', auto"},
        {"options",
         "further flags of hs-identify, quoted as in a shell; files that flags read (--data, "
         "--region) are inputs, and relative to the manifest's folder too; those that they write "
         "are made in DIR/recordings/NAME/files; a --library is relative to the folder where make "
         "runs, and is there already or allowed by --writes"},
        {"common_options",
         "flags of hs-identify, hs-diagnose and hs-simulate alike: --rim-edge 0.2"},
        {"scan_unit", "unit of the scan, m when empty"},
        {"import_options, scan_options, reconstruct_options, tetmesh_options, diagnose_options, "
         "simulate_options, "
         "compare_options",
         "further flags of these tools"},
        {"...", "other columns are carried through to the summary"}}},
      {"Summary (output)",
       {{"name, line", "of the manifest"},
        {"state", "done, failed or not run"},
        {"effects, E, nu", "of the model; E [Pa] and nu of region 0"},
        {"rmse, heldout, force_noise", "error of the fit and on unseen positions, noise [N]"},
        {"verdict, missing", "of the diagnosis: the model's, and the effects that it misses"},
        {"message, command", "of a failure: its line, and the command that repeats it"}}}};
  spec.examples = {
      {"make -f Makefile.pipeline batch MANIFEST=recordings.csv OUT=batch -j4",
       "Everything; again after an interruption or a change."},
      {"hs-batch recordings.csv --prepare --out batch", "The rules alone."},
      {"make -k -C batch -f batch.mk -j4 recording-liver-03", "One recording."},
      {"hs-batch recordings.csv --out batch --html batch/overview.html -o batch/summary.csv",
       "How far it is."}};
  spec.see_also = {"hs-identify(1)", "hs-diagnose(1)", "hs-compare(1)", "make(1)"};
  return spec;
}

int prepare(const Arguments& arguments, const Batch& batch) {
  const PrepareReport report = write_rules(batch, arguments[flag::bin], version());
  const auto also = [](std::size_t count, const char* what) {
    return count == 0 ? std::string() : fmt::format("; {} {}", count, what);
  };
  say(arguments, "hs-batch",
      fmt::format("{} recordings{}{}", report.ready,
                  also(report.refused, "cannot run as the manifest has them"),
                  also(report.failed_before, "failed before, and nothing has changed")));
  return 0;
}

// What make says: "step NAME" when a step of a recording begins, "finished NAME" when it is
// through.
void wait_for_make(const Arguments& arguments, const Batch& batch) {
  std::size_t ready = 0;
  for (std::size_t r = 0; r < batch.chain.size(); ++r)
    if (!batch.chain[r].empty()) ++ready;
  Progress progress(arguments, "", ready);
  std::set<std::string> worked, running;
  for (std::string line; std::getline(std::cin, line);) {
    const std::size_t space = line.find(' ');
    if (space == line.npos) continue;
    const std::string name = line.substr(space + 1);
    if (line.rfind("step ", 0) == 0) {
      worked.insert(name);
      running.insert(name);
    } else if (line.rfind("finished ", 0) == 0) {
      running.erase(name);
      if (worked.count(name) != 0)
        progress.step();
      else
        progress.found_done();
    } else {
      continue;
    }
    std::string names;
    for (const std::string& one : running) names += (names.empty() ? "" : ", ") + one;
    progress.running(names);
  }
}

int summarise(const Arguments& arguments, const Batch& batch) {
  const std::vector<RecordingOutcome> outcomes = read_outcomes(batch);
  namespace fs = std::filesystem;
  const fs::path beside = arguments.given(flag::html)
                              ? fs::absolute(arguments[flag::html]).parent_path()
                              : fs::current_path();
  const Overview overview = batch_overview(batch, outcomes, beside.string(), version());
  std::optional<Output> summary;
  if (result_is_wanted(arguments)) {
    summary.emplace(arguments.output());
    write_summary(summary->stream(), batch, outcomes);
  }
  if (arguments.given(flag::html)) {
    Output html(arguments[flag::html]);
    write_overview(html.stream(), overview);
    html.commit();
  }
  if (arguments.given(flag::junit)) {
    Output junit(arguments[flag::junit]);
    write_junit(junit.stream(), "hs-batch", batch_cases(batch, outcomes));
    junit.commit();
  }
  if (summary) summary->commit();
  for (std::size_t r = 0; r < outcomes.size(); ++r)
    if (outcomes[r].state == RecordingState::kFailed) {
      say(arguments, "hs-batch",
          fmt::format("failed: {}: {}", batch.manifest.rows[r].name, outcomes[r].message));
      if (!outcomes[r].command.empty())
        say(arguments, "hs-batch", "its step again: " + outcomes[r].command);
    }
  Summary told = batch_summary(outcomes, overview);
  if (arguments.given(flag::html)) told.details = "The overview: " + arguments.text(flag::html);
  tell_answer(arguments, told);
  return static_cast<int>(all_done(outcomes) ? ExitCode::kDone : ExitCode::kCheckFailed);
}

int run(const Arguments& arguments) {
  if (arguments[flag::prepare])
    for (const AnyFlag& flag :
         AnyFlags{flag::wait, flag::html, flag::junit, flag::json, flag::output})
      if (arguments.given(flag))
        fail_usage("--prepare and " + flag + " exclude each other", "prepare first");
  if (arguments[flag::wait] && arguments.input() == "-")
    fail_usage("--wait reads standard input, and so would the manifest", "name the manifest");
  BatchOptions options;
  options.folder = arguments[flag::out];
  while (options.folder.size() > 1 && options.folder.back() == '/') options.folder.pop_back();
  options.writes = arguments.list(flag::writes);
  options.step_time = arguments[flag::step_time];
  for (const std::string& folder : options.writes)
    if (folder.find('\n') != folder.npos)
      fail_usage("the name of --writes has a line break", "rename the folder");
  options.report = arguments[flag::stages] == "report";
  options.diagnosis = arguments[flag::stages] != "model";
  Input input(arguments.input());
  const Batch batch = plan_batch(read_manifest(input), options);
  if (arguments[flag::prepare]) return prepare(arguments, batch);
  if (arguments[flag::wait]) wait_for_make(arguments, batch);
  return summarise(arguments, batch);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
