#include "compare/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/shell_words.h"
#include "compare/report_body.h"
#include "compare/report_image.h"
#include "compare/report_tables.h"
#include "compare/wording.h"
#include "experiment/forces.h"
#include "experiment/labels.h"

namespace hapsim {
namespace {

// The last diagnosis tells the verdict; its first row is the model as a whole.
std::string model_verdict(const Report& report) {
  if (report.diagnoses.empty()) return "";
  for (const DiagnosisRow& row : report.diagnoses.back().rows)
    if (row.effect == "model") {
      for (const auto& [name, text] : row.notes)
        if (name == "evidence") return row.verdict + ": " + text;
      return row.verdict;
    }
  return "";
}

// A command on the recording with the body and the model of the report; FILE where it has none, and
// then it is no command to copy.
void set_command(const std::string& tool, const Recording& measured, const ReportExtras& extras,
                 const std::string& output, Report& report) {
  report.next = tool + " " + shell_quoted(measured.name);
  for (const char* kind : {"body", "model"}) {
    const auto file = std::find_if(extras.files.begin(), extras.files.end(),
                                   [&](const auto& known) { return known.first == kind; });
    const bool known = file != extras.files.end();
    report.next_is_command = report.next_is_command && known;
    report.next += fmt::format(" --{} {}", kind, known ? shell_quoted(file->second) : "FILE");
  }
  report.next += " -o " + output;
}

// What the last diagnosis asks for; without one, a diagnosis, unless sensor and meshes explain what
// is left; of a complete model, its use.
void add_next(const Recording& measured, const Comparison& c, const ReportExtras& extras,
              Report& report) {
  if (report.diagnoses.empty()) {
    if (within_doubt(c)) return;
    set_command("hs-diagnose", measured, extras, "effects.csv", report);
    return;
  }
  for (const DiagnosisRow& row : report.diagnoses.back().rows) {
    if (row.effect == "model" && row.verdict == "complete")
      set_command("hs-simulate", measured, extras, "forces.csv", report);
    if (row.verdict == "missing") report.next = row.command;
    if (row.verdict == "indistinguishable") {
      report.next_is_command = false;
      for (const auto& [name, text] : row.notes)
        if (name == kNextMeasurement) report.next = "to tell them apart: " + text;
    }
    if (!report.next.empty()) return;
  }
}

void add_provenance(const Recording& measured, const std::vector<SimulatedVersion>& versions,
                    const ReportExtras& extras, Report& report) {
  const auto add = [&](const char* key, const std::string& value) {
    report.provenance.emplace_back(key, value);
  };
  add("hapsim", extras.program);
  add("measured", measured.name);
  for (const SimulatedVersion& v : versions)
    add("simulated", v.name + (v.name == v.recording.name ? "" : " = " + v.recording.name));
  report.provenance.insert(report.provenance.end(), extras.files.begin(), extras.files.end());
  const auto metadata = [&](const Recording& r, const std::string& of) {
    for (const Metadata::Line& line : r.metadata.lines())
      report.provenance.emplace_back(of + (line.key.empty() ? " comment" : " " + line.key),
                                     line.value);
  };
  metadata(measured, "measured:");
  metadata(versions.back().recording, "simulated:");
}

}  // namespace

Report comparison_report(const Recording& measured, const std::vector<SimulatedVersion>& versions,
                         const Comparison& c, const ErrorMap& map, const ReportExtras& extras) {
  const Recording& simulated = versions.back().recording;
  Report report;
  report.title = extras.title.value_or("Measured and simulated forces of " +
                                       std::filesystem::path(measured.name).filename().string());
  if (extras.history) add_history(*extras.history, report);
  for (const auto& [version, table] : extras.diagnoses) add_diagnosis(table, version, report);
  const std::string diagnosed = model_verdict(report);
  report.verdict = verdict_line(c) + (diagnosed.empty() ? "" : " The model is " + diagnosed);
  report.good = diagnosed.empty() ? only_noise_left(c) : diagnosed.rfind("complete", 0) == 0;
  for (const Observation& o : c.observations) report.sentences.push_back(o.sentence);
  add_next(measured, c, extras, report);
  add_numbers(c, simulated.metadata, report);
  if (extras.model) add_parameters(*extras.model, report);
  const auto labels =
      extras.model ? acting_labels(material_of(*extras.model), extras.labels) : nullptr;
  add_body(c, map, extras.model ? &*extras.model : nullptr, labels.get(), report);
  if (versions.size() > 1)
    add_body_before(compare(measured, versions.front().recording), map, report);
  if (extras.image) {
    const auto file = std::find_if(extras.files.begin(), extras.files.end(),
                                   [](const auto& known) { return known.first == "inside"; });
    add_image(*extras.image, file == extras.files.end() ? "image" : file->second, report);
  }
  add_presses(measured, versions, c, report);
  add_residual_plots(measured, simulated, c, report);
  if (extras.model) {
    add_learned_curves(*extras.model, report);
    add_learned_places(*extras.model, report);
    add_slices(map.surface, *extras.model, labels.get(), report);
  }
  add_tables(c, report);
  add_chances(report);
  add_flags(measured, extras.flags, report);
  add_provenance(measured, versions, extras, report);
  return report;
}

}  // namespace hapsim
