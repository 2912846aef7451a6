#include "batch/outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "batch/step_script.h"
#include "effects/catalogue.h"
#include "io/csv.h"
#include "io/formula.h"

namespace hapsim {
namespace {

namespace fs = std::filesystem;

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

void read_model_file(const std::string& path, RecordingOutcome& outcome) {
  Input input(path);
  const CsvTable table = read_csv(input);
  const auto number = [&](const char* key) {
    return table.metadata.number(key, path).value_or(std::nan(""));
  };
  outcome.rmse = number("rmse");
  outcome.held_out = number("heldout");
  outcome.noise = number("force_noise");
  const int effect = table.find("effect"), region = table.find("region"),
            parameter = table.find("parameter"), value = table.find("value");
  if (effect < 0 || region < 0 || parameter < 0 || value < 0)
    fail_input(path, "this is no model", "remove it, and it is made again");
  const auto cell = [&](int column, std::size_t r) -> const std::string& {
    return table.columns[static_cast<std::size_t>(column)][r];
  };
  const EffectCard& body = body_effect().card();
  std::string last;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const std::string& name = cell(effect, r);
    if (name != last) outcome.effects += (last.empty() ? "" : "+") + name;
    last = name;
    if (name != body.name || cell(region, r) != "0") continue;
    if (cell(parameter, r) == body.modulus) outcome.modulus = cell(value, r);
    if (cell(parameter, r) == body.poissons_ratio) outcome.nu = cell(value, r);
  }
}

void read_diagnosis(const std::string& path, RecordingOutcome& outcome) {
  Input input(path);
  const CsvTable table = read_csv(input);
  const int effect = table.find("effect"), verdict = table.find("verdict");
  if (effect < 0 || verdict < 0)
    fail_input(path, "this is no diagnosis", "remove it, and it is made again");
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const std::string& name = table.columns[static_cast<std::size_t>(effect)][r];
    const std::string& word = table.columns[static_cast<std::size_t>(verdict)][r];
    if (name == "model")
      outcome.verdict = word;
    else if (word == "missing")
      outcome.missing += (outcome.missing.empty() ? "" : " ") + name;
  }
}

RecordingOutcome read_outcome(const Batch& batch, std::size_t r) {
  RecordingOutcome outcome;
  const std::vector<int>& chain = batch.chain[r];
  if (chain.empty()) {
    outcome.state = RecordingState::kFailed;
    outcome.message = one_line(batch.manifest.rows[r].problem);
    return outcome;
  }
  for (const int s : chain)
    if (!is_current(batch, batch.step_at(s))) return outcome;
  if (const auto failure = find_failure(batch, chain)) {
    outcome.state = RecordingState::kFailed;
    outcome.message = one_line(failure->text);
    for (const int s : chain)
      if (batch.step_at(s).name == failure->step) outcome.command = batch.step_at(s).command;
    return outcome;
  }
  for (const int s : chain)
    if (!fs::exists(fs::path(batch.options.folder) / batch.step_at(s).output)) return outcome;
  try {
    read_model_file(output_of(batch, r, "model"), outcome);
    if (batch.options.diagnosis) read_diagnosis(output_of(batch, r, "diagnosis"), outcome);
    outcome.state = RecordingState::kDone;
  } catch (const Error& error) {
    outcome.state = RecordingState::kFailed;
    outcome.message = one_line(error.what());
  }
  return outcome;
}

}  // namespace

std::optional<StepFailure> find_failure(const Batch& batch, const std::vector<int>& chain) {
  for (const int s : chain) {
    const BatchStep& step = batch.step_at(s);
    std::ifstream file(fs::path(batch.options.folder) / step.folder / "failure");
    StepFailure failure;
    std::string code;
    if (!std::getline(file, failure.step) || !std::getline(file, code)) continue;
    double number = 0;
    if (failure.step != step.name || !parse_number(code, number)) continue;
    failure.code = static_cast<int>(number);
    std::getline(file, failure.text);
    if (failure.code > 128)
      failure.text = fmt::format("{} was ended by signal {}{}", failure.step, failure.code - 128,
                                 failure.code == 137 ? " (out of memory? use a smaller -j)" : "");
    if (failure.text.empty())
      failure.text = fmt::format("{} ended with code {}", failure.step, failure.code);
    return failure;
  }
  return std::nullopt;
}

std::vector<RecordingOutcome> read_outcomes(const Batch& batch) {
  std::vector<RecordingOutcome> outcomes;
  for (std::size_t r = 0; r < batch.chain.size(); ++r) outcomes.push_back(read_outcome(batch, r));
  return outcomes;
}

void write_summary(std::ostream& out, const Batch& batch,
                   const std::vector<RecordingOutcome>& outcomes) {
  std::vector<std::string> header{"name",    "line",    "state",   "effects",     "E",
                                  "nu",      "rmse",    "heldout", "force_noise", "verdict",
                                  "missing", "message", "command"};
  const std::vector<std::string>& extra = batch.manifest.extra_header;
  for (const std::string& name : extra) {
    const bool taken = std::find(header.begin(), header.end(), name) != header.end();
    header.push_back(taken ? "manifest_" + name : name);
  }
  for (std::string& name : header) name = without_formula(name);
  CsvWriter writer(out, {}, header);
  // Six digits: the last ones may differ from run to run, and equal results are to be equal bytes.
  const auto number = [](double v) {
    return std::isfinite(v) ? fmt::format("{:.6g}", v) : std::string();
  };
  const auto rounded = [&](const std::string& text) {
    double v = 0;
    return parse_number(text, v) ? number(v) : text;
  };
  for (std::size_t r = 0; r < outcomes.size(); ++r) {
    const ManifestRow& row = batch.manifest.rows[r];
    const RecordingOutcome& o = outcomes[r];
    const char* state = o.state == RecordingState::kDone     ? "done"
                        : o.state == RecordingState::kFailed ? "failed"
                                                             : "not run";
    std::vector<std::string> fields{row.name,
                                    std::to_string(row.line),
                                    state,
                                    o.effects,
                                    rounded(o.modulus),
                                    rounded(o.nu),
                                    number(o.rmse),
                                    number(o.held_out),
                                    number(o.noise),
                                    o.verdict,
                                    o.missing,
                                    o.message,
                                    o.command};
    fields.insert(fields.end(), row.extra.begin(), row.extra.end());
    for (std::string& field : fields) field = without_formula(field);
    writer.row(fields);
  }
}

}  // namespace hapsim
