#include "batch/batch_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "io/number.h"

namespace hapsim {
namespace {

std::size_t count(const std::vector<RecordingOutcome>& outcomes, RecordingState state) {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(), [&](auto& o) { return o.state == state; }));
}

std::string four_digits(const std::string& text) {
  double value = 0;
  return parse_number(text, value) ? fmt::format("{:.4g}", value) : text;
}

}  // namespace

std::string batch_verdict(const std::vector<RecordingOutcome>& outcomes) {
  const std::size_t failed = count(outcomes, RecordingState::kFailed);
  const std::size_t open = count(outcomes, RecordingState::kNotRun);
  std::string verdict = fmt::format("{} of {} recordings done",
                                    count(outcomes, RecordingState::kDone), outcomes.size());
  if (failed > 0) verdict += fmt::format(", {} failed", failed);
  if (open > 0) verdict += fmt::format(", {} not run", open);
  return verdict;
}

bool all_done(const std::vector<RecordingOutcome>& outcomes) {
  return count(outcomes, RecordingState::kDone) == outcomes.size();
}

Overview batch_overview(const Batch& batch, const std::vector<RecordingOutcome>& outcomes,
                        const std::string& folder, const std::string& program) {
  namespace fs = std::filesystem;
  Overview page;
  page.title = "Recordings of " + batch.manifest.name;
  page.verdict = batch_verdict(outcomes);
  page.provenance = {
      {"manifest", batch.manifest.name}, {"folder", batch.options.folder}, {"hapsim", program}};
  for (std::size_t r = 0; r < outcomes.size(); ++r) {
    const RecordingOutcome& o = outcomes[r];
    const std::string& name = batch.manifest.rows[r].name;
    if (o.state == RecordingState::kNotRun) page.not_run.push_back(name);
    if (o.state == RecordingState::kFailed) page.failures.push_back({name, o.message, o.command});
    if (o.state != RecordingState::kDone) continue;
    OverviewRow row{name, "", o.effects, o.verdict, o.missing, batch.manifest.rows[r].effects};
    row.rmse = o.rmse;
    row.held_out = o.held_out;
    row.noise = o.noise;
    row.modulus = four_digits(o.modulus);
    row.nu = four_digits(o.nu);
    if (const std::string report = output_of(batch, r, "report"); !report.empty())
      row.link = fs::absolute(report).lexically_relative(folder).string();
    page.rows.push_back(std::move(row));
  }
  return page;
}

std::vector<JunitCase> batch_cases(const Batch& batch,
                                   const std::vector<RecordingOutcome>& outcomes) {
  std::vector<JunitCase> cases;
  for (std::size_t r = 0; r < outcomes.size(); ++r) {
    const RecordingOutcome& o = outcomes[r];
    cases.push_back({batch.manifest.rows[r].name, o.message,
                     o.command.empty() ? "" : o.message + "\n" + o.command,
                     o.state == RecordingState::kNotRun});
  }
  return cases;
}

}  // namespace hapsim
