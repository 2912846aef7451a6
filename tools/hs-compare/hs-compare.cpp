// hs-compare: measured against simulated forces, row by row, and what the difference depends on.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"
#include "formats/body_input.h"
#include "hs-compare/body.h"
#include "hs-compare/follow.h"
#include "hs-compare/report.h"
#include "hs-compare/specification.h"
#include "io/quantity.h"
#include "report/figures.h"
#include "report/junit.h"

namespace hapsim {
namespace {

// Limit of --fail-above in newtons.
struct Limit {
  double factor = 0;
  enum class Unit { kNewton, kPercent, kNoise } unit = Unit::kNewton;
  double newtons_of(const Comparison& c) const {
    if (unit == Unit::kPercent) return factor / 100 * c.size.force_rms;
    return unit == Unit::kNoise ? factor * c.noise.value : factor;
  }
};

Limit parse_limit(const std::string& text) {
  const auto end = text.find_last_of("0123456789.");
  const std::string unit(trim(end == text.npos ? text : text.substr(end + 1)));
  Limit limit;
  const bool number = end != text.npos && parse_number(text.substr(0, end + 1), limit.factor);
  if (unit == "%")
    limit.unit = Limit::Unit::kPercent;
  else if (unit == "noise" || unit == "xnoise")
    limit.unit = Limit::Unit::kNoise;
  else if (number && !unit.empty())
    limit.factor = parse_quantity(text, Quantity::kForce, "--fail-above");
  if (!number || unit.empty() || limit.factor < 0)
    fail_usage(
        "--fail-above " + shown(text) + " is not a limit",
        "give newtons, per cent of the force or multiples of the noise: 0.05N, 5%, 1.5noise");
  return limit;
}

std::vector<Version> read_versions(const Arguments& arguments, const Recording& measured) {
  std::vector<Version> versions;
  for (const std::string& text : arguments.list("--simulated")) {
    const auto equals = text.find('=');
    const bool named = equals != text.npos && equals > 0 && !std::filesystem::exists(text);
    const std::string path = named ? text.substr(equals + 1) : text;
    Input input(path);
    Version version{"", read_recording(input)};
    version.name = named ? text.substr(0, equals)
                         : version.recording.metadata.find("simulated")
                               .value_or(path == "-" ? "simulated" : path);
    check_match(measured, version.recording);
    versions.push_back(std::move(version));
  }
  return versions;
}

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

void add_provenance(const Arguments& arguments, const Recording& measured,
                    const std::vector<Version>& versions, Report& report) {
  const auto add = [&](const char* key, const std::string& value) {
    report.provenance.emplace_back(key, value);
  };
  add("hapsim", version());
  add("measured", measured.name);
  for (const Version& v : versions)
    add("simulated", v.name + (v.name == v.recording.name ? "" : " = " + v.recording.name));
  for (const char* flag : {"--body", "--model", "--history"})
    if (arguments.given(flag)) add(flag + 2, arguments.text(flag));
  for (const std::string& diagnosis : arguments.list("--diagnosis")) add("diagnosis", diagnosis);
  const auto metadata = [&](const Recording& r, const std::string& of) {
    for (const Metadata::Line& line : r.metadata.lines())
      report.provenance.emplace_back(of + (line.key.empty() ? " comment" : " " + line.key),
                                     line.value);
  };
  metadata(measured, "measured:");
  metadata(versions.back().recording, "simulated:");
}

Report make_report(const Arguments& arguments, const Recording& measured,
                   const std::vector<Version>& versions, const Comparison& c, const ErrorMap& map) {
  Report report;
  report.title = arguments.given("--title")
                     ? arguments.text("--title")
                     : "Measured and simulated forces of " +
                           std::filesystem::path(measured.name).filename().string();
  if (arguments.given("--history")) {
    Input input(arguments.text("--history"));
    add_history(read_csv(input), report);
  }
  for (const std::string& diagnosis : arguments.list("--diagnosis")) {
    const std::size_t equals = diagnosis.find('=');
    Input input(equals == std::string::npos ? diagnosis : diagnosis.substr(equals + 1));
    add_diagnosis(read_csv(input), equals == std::string::npos ? "" : diagnosis.substr(0, equals),
                  report);
  }
  const std::string diagnosed = model_verdict(report);
  report.verdict = verdict_line(c) + (diagnosed.empty() ? "" : " The model is " + diagnosed);
  report.good = diagnosed.empty() ? c.observations.empty() && c.size.rmse <= 1.15 * c.noise.value
                                  : diagnosed.rfind("complete", 0) == 0;
  for (const Observation& o : c.observations) report.sentences.push_back(o.sentence);
  add_numbers(c, versions.back().recording.metadata, report);
  std::optional<Model> model;
  if (arguments.given("--model")) {
    Input input(arguments.text("--model"));
    model = read_model(input);
    add_parameters(*model, report);
  }
  add_body(c, map, model ? &*model : nullptr, report);
  add_presses(measured, versions, c, report);
  add_residual_plots(measured, versions.back().recording, c, report);
  add_tables(c, report);
  add_provenance(arguments, measured, versions, report);
  return report;
}

void summarise(const Arguments& arguments, const std::vector<Version>& versions,
               const Recording& measured, const Comparison& c) {
  const auto line = [&](const std::string& text) { say(arguments, "hs-compare", text); };
  line(verdict_line(c));
  line(fmt::format(
      "rmse {} over {} rows, measured components pooled (x {:.3g}, y {:.3g}, z {:.3g}); {} of the "
      "force's rms, {} of its peak {}",
      newtons(c.size.rmse), measured.rows(), c.size.rmse_axis[0], c.size.rmse_axis[1],
      c.size.rmse_axis[2], percent_of(c.size.rmse, c.size.force_rms),
      percent_of(c.size.rmse, c.size.force_peak), newtons(c.size.force_peak)));
  line(fmt::format("sensor noise {} ({}): the error is {} times that", newtons(c.noise.value),
                   c.noise.estimated ? "estimated from differences in time: there is no "
                                       "force_noise in the recording"
                                     : "force_noise of the recording",
                   times_noise(c)));
  if (versions.size() > 1)
    for (const Version& v : versions)
      line(fmt::format("  {}: rmse {}", v.name,
                       newtons(error_size(measured.f, v.recording.f).rmse)));
  for (const Observation& o : c.observations) line("  " + o.sentence);
  if (c.observations.empty())
    line("  no structure beyond noise: the error depends on nothing that was looked at");
  const std::vector<int> worst = c.worst_positions();
  for (std::size_t i = 0; i < std::min<std::size_t>(3, worst.size()) && worst.size() > 1; ++i) {
    const BinError& e = c.by_position().errors[static_cast<std::size_t>(worst[i])];
    line(fmt::format("  {} {}: rmse {}, {}", i == 0 ? "worst position" : "          then",
                     c.by_position().grouping.bins[static_cast<std::size_t>(worst[i])].label,
                     newtons(e.rmse), stiffness_words(e)));
  }
}

// Where the error is largest stands with a failure.
void write_verdict(const Arguments& arguments, const Recording& measured, const Comparison& c,
                   const std::string& excess) {
  std::string details = excess;
  for (const Observation& o : c.observations) details += "\n" + o.sentence;
  const std::vector<int> worst = c.worst_positions();
  if (!worst.empty())
    details += "\nworst position " +
               c.by_position().grouping.bins[static_cast<std::size_t>(worst[0])].label;
  Output junit(arguments.text("--junit"));
  write_junit(junit.stream(), "hs-compare",
              {{measured.name + " below " + arguments.text("--fail-above"), excess, details}});
  junit.commit();
}

int run(const Arguments& arguments) {
  if (arguments.given("--follow")) return run_follow(arguments);
  for (const Option& option : follow_flags())
    if (arguments.given(option.flag))
      fail_usage(option.flag + " is of a stream", "add --follow, or leave it out");
  if (!arguments.given("--simulated"))
    fail_usage("--simulated is required", "give forces from hs-simulate, or --follow");
  Limit limit;
  if (arguments.given("--fail-above")) limit = parse_limit(arguments.text("--fail-above"));
  if (arguments.given("--junit") && !arguments.given("--fail-above"))
    fail_usage("--junit tells a verdict, and none is asked for", "add --fail-above 1.5noise");
  if (arguments.given("--ply") && !arguments.given("--body"))
    fail_usage("--ply colours a surface, and none is given", "add --body body.ply");
  Input input(arguments.input());
  const Recording measured = read_recording(input);
  const std::vector<Version> versions = read_versions(arguments, measured);
  const Recording& simulated = versions.back().recording;
  const Comparison c = compare(measured, simulated);

  ErrorMap map;
  if (arguments.given("--body")) {
    std::vector<double> error;
    for (const BinError& e : c.by_position().errors) error.push_back(e.rmse);
    Input body(arguments.text("--body"));
    map = map_error(read_outside(body), c.facts.positions, error,
                    arguments.given("--reach") ? arguments.number("--reach") : 0);
  }

  // All outputs are written before the first is put in its place.
  std::vector<std::unique_ptr<Output>> outputs;
  const auto open = [&](const std::string& path) -> std::ostream& {
    outputs.push_back(std::make_unique<Output>(path));
    return outputs.back()->stream();
  };
  if (arguments.given("--html") || arguments.given("--figures")) {
    const Report report = make_report(arguments, measured, versions, c, map);
    if (arguments.given("--html")) write_report(open(arguments.text("--html")), report);
    if (arguments.given("--figures"))
      for (const auto& [name, text] : report_figures(report))
        open(arguments.text("--figures") + name) << text;
  }
  if (arguments.given("--json"))
    open(arguments.text("--json")) << comparison_json(c, measured.name, simulated.name);
  if (arguments.given("--ply"))
    write_ply(open(arguments.text("--ply")), coloured_ply(map, top_error(c)));
  if (arguments.given("--output") || isatty(STDOUT_FILENO) != 1)
    write_recording(open(arguments.output()), with_residuals(measured, simulated.f));
  for (const auto& output : outputs) output->stream().flush();
  std::for_each(outputs.rbegin(), outputs.rend(), [](auto& output) { output->commit(); });

  summarise(arguments, versions, measured, c);
  if (!arguments.given("--fail-above")) return 0;
  const double most = limit.newtons_of(c);
  if (limit.unit == Limit::Unit::kNoise && !(c.noise.value > 0))
    fail_input(measured.name, "the noise is not known, so --fail-above in noise cannot be judged",
               "add a line '# force_noise: 0.02' (newtons), or give the limit in N");
  const bool failed = c.size.rmse > most;
  const std::string excess = fmt::format("typical error {} exceeds {} ({})", newtons(c.size.rmse),
                                         newtons(most), arguments.text("--fail-above"));
  if (arguments.given("--junit")) write_verdict(arguments, measured, c, failed ? excess : "");
  if (!failed) return 0;
  tell("hs-compare", excess);
  return static_cast<int>(ExitCode::kCheckFailed);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::compare_specification(), argc, argv, hapsim::run);
}
