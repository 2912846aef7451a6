// hs-compare: measured against simulated forces, row by row, and what the difference depends on.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/shell_words.h"
#include "calibration_option.h"
#include "cli/tell.h"
#include "compare/comparison_report.h"
#include "compare/error_limit.h"
#include "compare/error_surface.h"
#include "compare/report_body.h"
#include "compare/wording.h"
#include "formats/body_input.h"
#include "hs-compare/flags.h"
#include "hs-compare/follow.h"
#include "hs-compare/specification.h"
#include "marked_points.h"
#include "recording/tools_together.h"
#include "report/figures.h"
#include "safety/flag_meanings.h"

namespace hapsim {
namespace {

std::vector<SimulatedVersion> read_versions(const Arguments& arguments, const Recording& measured) {
  std::vector<SimulatedVersion> versions;
  for (const std::string& text : arguments.list(flag::simulated)) {
    const auto equals = text.find('=');
    const bool named = equals != text.npos && equals > 0 && !std::filesystem::exists(text);
    const std::string path = named ? text.substr(equals + 1) : text;
    Input input(path);
    SimulatedVersion version{"", read_recording(input)};
    version.name = named ? text.substr(0, equals)
                         : version.recording.metadata.find("simulated")
                               .value_or(path == "-" ? "simulated" : path);
    check_match(measured, version.recording);
    versions.push_back(std::move(version));
  }
  return versions;
}

// What the report tells beside the forces, read from the files that were given.
ReportExtras read_extras(const Arguments& arguments,
                         const std::shared_ptr<const BodyRegions>& labels,
                         std::optional<ImageOnBody> image) {
  ReportExtras extras;
  extras.program = version();
  extras.flags = live_flag_meanings();
  if (arguments.given(flag::title)) extras.title = arguments[flag::title];
  if (arguments.given(flag::history)) {
    Input input(arguments[flag::history]);
    extras.history = read_csv(input);
  }
  for (const std::string& diagnosis : arguments.list(flag::diagnosis)) {
    const std::size_t equals = diagnosis.find('=');
    Input input(equals == std::string::npos ? diagnosis : diagnosis.substr(equals + 1));
    extras.diagnoses.emplace_back(equals == std::string::npos ? "" : diagnosis.substr(0, equals),
                                  read_csv(input));
  }
  if (arguments.given(flag::model)) {
    Input input(arguments[flag::model]);
    extras.model = read_model(input);
  }
  extras.labels = labels;
  extras.image = std::move(image);
  for (const AnyFlag& flag : AnyFlags{flag::body, flag::model, flag::inside, flag::history})
    if (arguments.given(flag)) extras.files.emplace_back(flag.name + 2, arguments.text(flag));
  for (const std::string& diagnosis : arguments.list(flag::diagnosis))
    extras.files.emplace_back("diagnosis", diagnosis);
  return extras;
}

// A diagnosis of the model, where more than noise is left, none was given, and all its files were.
std::string next_command(const Arguments& arguments, const Comparison& c) {
  if (arguments.input() == "-" || within_doubt(c) || arguments.given(flag::diagnosis)) return "";
  if (!arguments.given(flag::body) || !arguments.given(flag::model)) return "";
  return "hs-diagnose " + shell_quoted(arguments.input()) + " --body " +
         shell_quoted(arguments[flag::body]) + " --model " + shell_quoted(arguments[flag::model]) +
         calibration_words(arguments) + " -o effects.csv";
}

int run(const Arguments& arguments) {
  if (arguments[flag::follow]) {
    if (arguments.given(flag::calibration))
      fail_usage("--calibration is of recordings, and --follow reads a stream",
                 "leave one of them out");
    return run_follow(arguments);
  }
  for (const Option& option : follow_flags())
    if (arguments.given(option.flag))
      fail_usage(option.flag + " is of a stream", "add --follow, or leave it out");
  if (!arguments.given(flag::simulated))
    fail_usage("--simulated is required", "give forces from hs-simulate, or --follow");
  if (arguments.given(flag::markers) != arguments.given(flag::simulated_markers))
    fail_usage("--markers and --simulated-markers go together",
               "simulate the points: hs-simulate ... --markers seen.csv --markers-out points.csv");
  ErrorLimit limit;
  if (arguments.given(flag::fail_above))
    limit = parse_error_limit(arguments[flag::fail_above], flag::fail_above.name);
  if (arguments.given(flag::junit) && !arguments.given(flag::fail_above))
    fail_usage("--junit tells a verdict, and none is asked for", "add --fail-above 1.5noise");
  if (arguments.given(flag::inside) && !arguments.given(flag::html))
    fail_usage("--inside is shown in the report, and none is asked for", "add --html report.html");
  if (arguments.given(flag::ply) && !arguments.given(flag::body))
    fail_usage("--ply colours a surface, and none is given", "add --body body.ply");
  Input input(arguments.input());
  const Recording measured = read_measured(arguments, input);
  const std::vector<SimulatedVersion> versions = read_versions(arguments, measured);
  const Recording& simulated = versions.back().recording;
  Comparison c = compare(measured, simulated);
  if (const std::optional<MarkerTable> seen = asked_markers(arguments)) {
    Input of_model(arguments[flag::simulated_markers]);
    c.markers = compare_markers(*seen, read_markers(of_model, true));
  }

  ErrorMap map;
  std::shared_ptr<const BodyRegions> labels;
  std::optional<ImageOnBody> image;
  if (arguments.given(flag::inside)) {
    Input file(arguments[flag::inside]);
    image = read_image(file);
  }
  if (arguments.given(flag::body) || image) {
    std::vector<double> error;
    for (const BinError& e : c.by_position().errors) error.push_back(e.rmse);
    std::optional<TetMesh> inside;
    Surface outside;
    if (arguments.given(flag::body)) {
      Input body(arguments[flag::body]);
      outside = read_outside(body, &inside);
    } else {
      outside = boundary_surface(image->body);
    }
    if (inside) labels = BodyRegions::of(*inside);
    map = map_error(outside, c.facts.positions, error,
                    arguments.given(flag::reach) ? arguments[flag::reach] : 0);
  }

  // All outputs are written before the first is put in its place.
  std::vector<std::unique_ptr<Output>> outputs;
  const auto open = [&](const std::string& path) -> std::ostream& {
    outputs.push_back(std::make_unique<Output>(path));
    return outputs.back()->stream();
  };
  if (arguments.given(flag::html) || arguments.given(flag::figures)) {
    const Report report = comparison_report(measured, versions, c, map,
                                            read_extras(arguments, labels, std::move(image)));
    if (arguments.given(flag::html)) write_report(open(arguments[flag::html]), report);
    if (arguments.given(flag::figures))
      for (const auto& [name, text] : report_figures(report))
        open(arguments[flag::figures] + name) << text;
  }
  if (arguments.given(flag::json))
    open(arguments[flag::json]) << comparison_json(c, measured.name, simulated.name);
  if (arguments.given(flag::ply))
    write_ply(open(arguments[flag::ply]), coloured_ply(map, top_error(c)));
  if (result_is_wanted(arguments))
    write_recording(open(arguments.output()), residuals_of(c, measured, simulated));
  for (const auto& output : outputs) output->stream().flush();
  std::for_each(outputs.rbegin(), outputs.rend(), [](auto& output) { output->commit(); });

  Summary summary = comparison_summary(c, measured, versions);
  summary.next = next_command(arguments, c);
  if (!within_doubt(c) && !arguments.given(flag::diagnosis) && summary.next.empty())
    summary.notes.push_back(
        "hs-diagnose, given the recording, its body and the model, says what is missing.");
  if (const std::string together = tools_together(measured); !together.empty())
    summary.notes.push_back(together);
  if (arguments.given(flag::html)) summary.details = "The report: " + arguments.text(flag::html);
  say_summary(arguments, summary);
  if (!arguments.given(flag::fail_above)) return 0;
  const std::string excess = excess_over(limit, c, measured.name);
  if (arguments.given(flag::junit)) {
    Output junit(arguments[flag::junit]);
    write_junit(junit.stream(), "hs-compare", {error_case(limit, c, measured.name)});
    junit.commit();
  }
  if (excess.empty()) return 0;
  tell("hs-compare", excess);
  return static_cast<int>(ExitCode::kCheckFailed);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::compare_specification(), argc, argv, hapsim::run);
}
