#include "batch/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/shell_words.h"
#include "batch/outcome.h"
#include "batch/step_script.h"

namespace hapsim {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& path, const std::string& text) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  return file && bytes << file.rdbuf() && bytes.str() == text;
}

void write_if_changed(const fs::path& path, const std::string& text) {
  if (holds(path, text)) return;
  Output output(path.string());
  output.write(text);
  output.commit();
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) fail_io(path.string(), "cannot be made: " + error.message(), "choose another --out");
}

// A name that make takes as it stands.
bool plain_to_make(const std::string& path) {
  return path.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
             "_./-+,@") == path.npos;
}

// The user's file as a prerequisite: by its full name, or by a link where make would misread that.
std::string prerequisite(const fs::path& folder, const std::string& path) {
  const std::string full = fs::absolute(path).lexically_normal().string();
  if (plain_to_make(full)) return full;
  const std::string link = "links/" + plain_name(full);
  make_folder(folder / "links");
  std::error_code error;
  if (fs::read_symlink(folder / link, error) == full) return link;
  fs::remove(folder / link, error);
  fs::create_symlink(full, folder / link, error);
  if (error) fail_io((folder / link).string(), error.message(), "choose another --out");
  return link;
}

constexpr const char* kStepScript = R"(#!/bin/sh
# step.sh FOLDER STEP OUTPUT [INPUT...]: runs FOLDER/STEP.sh, which makes OUTPUT. INPUTs come from
# earlier steps: where one is missing, that step failed. Ends with 0 also when the step fails, which
# FOLDER/failure then says; with another code when it was stopped from outside.
batch={}
cd {} || exit 1
{}folder=$batch/$1 step=$2 output=$batch/$3 stopped=
shift 3
for input; do [ -e "$batch/$input" ] || exit 0; done
echo "step ${{folder##*/}}"
log=$folder/$step.log
# What the manifest's options may write: they are somebody else's words.
HAPSIM_WRITES="$output
$folder/block.ply
$folder/files/
/dev/null"{}
export HAPSIM_WRITES
limit={} begun=$(date +%s)
trap stopped=yes HUP INT TERM
timeout --foreground --kill-after=10 $limit sh "$folder/$step.sh" </dev/null >/dev/null 2>"$log.$$"
code=$?
# 124: it was ended for its time, 137: by force; the latter may also be want of memory.
if [ $code = 124 ] || {{ [ $code = 137 ] && [ $(($(date +%s) - begun)) -ge $limit ]; }}; then
  code=124
  echo "$step had not ended after $limit s; is its input whole? else allow more by --step-time" >>"$log.$$"
fi
# An identification that is interrupted ends with 4, and leaves the best model so far.
[ $code != 4 ] || case $(tail -n 1 "$log.$$") in *": the fit was interrupted"* | *": interrupted while"*) stopped=yes ;; esac
# --help and the like among the options end well, and make nothing.
[ $code != 0 ] || [ -e "$output" ] || {{ code=2; echo "$step made no output; take out flags that end it early, as --help" >>"$log.$$"; }}
[ $code = 0 ] || [ -z "$stopped" ] || {{ rm -f "$log.$$" "$output"; exit 143; }}
case $code in
  0) rm -f "$folder/failure" ;;
  129 | 130 | 131 | 143) rm -f "$log.$$"; exit $code ;;
  *)
    rm -f "$output"
    {{ printf '%s\n%s\n' "$step" $code; tail -n 1 "$log.$$"; }} >"$folder/failure.$$" &&
      mv -f "$folder/failure.$$" "$folder/failure" || exit 1
    ;;
esac
mv -f "$log.$$" "$log"
)";

// One task of a job array of Slurm, which sets the two numbers; without them, all recordings.
constexpr const char* kArrayScript = R"(#!/bin/sh
# array.sh [TARGET]: makes every COUNT-th recording of the file targets, or TARGET.
cd {} || exit 1
if [ $# -gt 0 ]; then exec make --no-print-directory -k -f batch.mk "$1"; fi
awk -v count="${{SLURM_ARRAY_TASK_COUNT:-1}}" -v id="${{SLURM_ARRAY_TASK_ID:-1}}" \
  'NR % count == id % count' targets | xargs make --no-print-directory -k -f batch.mk
)";

// More lines of HAPSIM_WRITES, as words of the shell.
std::string allowed_folders(const std::vector<std::string>& folders) {
  std::string lines;
  for (const std::string& folder : folders)
    lines += shell_quoted("\n" + fs::absolute(folder).lexically_normal().string() + "/");
  return lines;
}

// Removes what is to be made anew: the results and failures of the steps whose script is another
// now, and of all that build on them. Before any script is written: a kill on the way then leaves
// nothing stale behind.
void remove_stale(const Batch& batch, const std::vector<std::string>& scripts) {
  const fs::path folder = batch.options.folder;
  std::set<std::string> stale;  // outputs
  for (std::size_t s = 0; s < batch.steps.size(); ++s) {
    const BatchStep& step = batch.steps[s];
    const bool on_stale = std::any_of(step.made.begin(), step.made.end(),
                                      [&](const auto& input) { return stale.count(input) != 0; });
    if (!on_stale && holds(script_path(batch, step), scripts[s])) continue;
    stale.insert(step.output);
    std::error_code error;  // what is not there need not be removed
    fs::remove(folder / step.output, error);
    if (const auto failure = find_failure(batch, {static_cast<int>(s)}))
      fs::remove(folder / step.folder / "failure", error);
  }
}

bool is_ahead(const fs::path& path) {
  std::error_code error;
  const auto time = fs::last_write_time(path, error);
  return !error && time > fs::file_time_type::clock::now();
}

void write_scripts(const Batch& batch, const std::vector<std::string>& scripts) {
  for (const BatchStep& step : batch.steps)
    make_folder(fs::path(batch.options.folder) / step.folder / (step.writes_files ? "files" : ""));
  remove_stale(batch, scripts);
  for (std::size_t s = 0; s < batch.steps.size(); ++s) {
    const fs::path path = script_path(batch, batch.steps[s]);
    write_if_changed(path, scripts[s]);
    // One from before the clock was stepped back would have its step made again and again.
    std::error_code error;
    if (is_ahead(path)) fs::last_write_time(path, fs::file_time_type::clock::now(), error);
  }
}

// Whether the chain failed for a reason that stays: its failure outlived the removal of the stale.
bool fails_again(const Batch& batch, const std::vector<int>& chain) {
  const std::optional<StepFailure> failure = find_failure(batch, chain);
  return failure && failure->code >= 2 && failure->code <= 4;
}

// Made once for all recordings that need it.
bool is_shared(const BatchStep& step) {
  return step.folder.rfind("bodies/", 0) == 0;
}

std::string rule_of(const BatchStep& step, const fs::path& folder) {
  std::string made, given;
  for (const std::string& input : step.made) made += " " + input;
  // A file from the future is newer than whatever is made of it.
  for (const std::string& input : step.given)
    if (!is_ahead(input)) given += " " + prerequisite(folder, input);
  return fmt::format("{0}: {1}/{2}.sh{3}{4}\n\t@$(STEP) step.sh {1} {2} {0}{4}\n", step.output,
                     step.folder, step.name, given, made);
}

}  // namespace

PrepareReport write_rules(const Batch& batch, const std::string& bin, const std::string& version) {
  const fs::path folder = batch.options.folder;
  make_folder(folder);
  const std::string here = fs::current_path().string();
  const std::string absolute = shell_quoted(fs::absolute(folder).lexically_normal().string());
  write_if_changed(
      folder / "step.sh",
      fmt::format(
          kStepScript, absolute, shell_quoted(here),
          bin.empty()
              ? ""
              : "PATH=" + shell_quoted(fs::absolute(bin).lexically_normal().string()) + ":$PATH\n",
          allowed_folders(batch.options.writes), std::ceil(batch.options.step_time)));
  write_if_changed(folder / "array.sh", fmt::format(kArrayScript, absolute));
  std::vector<std::string> scripts;
  for (const BatchStep& step : batch.steps) scripts.push_back(script_of(step, version));
  write_scripts(batch, scripts);

  PrepareReport report;
  std::string all, bodies, targets, rules;
  std::set<int> written;
  for (std::size_t r = 0; r < batch.chain.size(); ++r) {
    const ManifestRow& row = batch.manifest.rows[r];
    if (batch.chain[r].empty()) {
      ++report.refused;
      continue;
    }
    if (fails_again(batch, batch.chain[r])) {
      ++report.failed_before;
      continue;
    }
    ++report.ready;
    const std::string target = "recording-" + row.folder;
    all += " " + target;
    targets += target + "\n";
    std::string own, body;  // what the recording shares with others
    for (const int s : batch.chain[r]) {
      const BatchStep& step = batch.step_at(s);
      if (!is_shared(step)) {
        own += rule_of(step, folder);
        continue;
      }
      if (step.name == "body") body = step.output;
      if (!written.insert(s).second) continue;
      if (step.name == "body") bodies += " " + step.output;
      rules += rule_of(step, folder);
    }
    const std::string file = "recordings/" + row.folder + "/rules.mk";
    write_if_changed(folder / file,
                     fmt::format("STEP := sh\nMAKEFLAGS += -rR\n.PHONY: recording\nrecording: {}\n"
                                 "\t@echo finished {}\n{}{}",
                                 batch.step_at(batch.chain[r].back()).output, row.folder,
                                 body.empty() ? "" : body + ":\n", own));
    rules += fmt::format("{}: {}\n\t+@$(MAKE) -f {}\n", target, body, file);
  }
  Output output((folder / "batch.mk").string());
  output.write("# Written by hs-batch.\nSTEP := sh\nall:" + all + "\nbodies:" + bodies +
               "\n.PHONY: all bodies" + all + "\nMAKEFLAGS += -rR --no-print-directory\n" + rules);
  output.commit();
  Output list((folder / "targets").string());
  list.write(targets);
  list.commit();
  return report;
}

}  // namespace hapsim
