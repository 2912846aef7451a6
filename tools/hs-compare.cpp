// hs-compare: measured against simulated forces, row by row, and what the difference depends on.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"
#include "compare_follow.h"
#include "compare_report.h"
#include "geometry/tetmesh.h"
#include "io/ply.h"
#include "report/figures.h"
#include "report/junit.h"
#include "report/palette.h"

namespace hapsim {
namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-compare";
  spec.summary = "measured against simulated forces, and what the difference depends on";
  spec.input = "measured recording CSV (press,t,x,y,z,ux,uy,uz,fx,fy,fz)";
  spec.description = {
      "Subtracts simulated from measured forces, row by row, and tells how large the difference "
      "is, "
      "how it compares with the sensor's noise, where it is largest, and what it depends on: "
      "position, depth, speed, time since contact, session time, temperature, direction, loading "
      "or "
      "unloading, the first or a later press of a place.",
      "The typical error (rmse) is the root of the mean of all squared component residuals: all "
      "rows, the three components pooled. So it compares with the noise of one component. Per cent "
      "are of the same mean of the measured force, and of its peak.",
      "Noise is the recording's metadata force_noise, otherwise estimated from second differences "
      "in time, median(|d2|) / (0.6745 sqrt 6), which is too small when the noise is not white.",
      "Within a group of rows the measured force is fitted as gain times simulated force; 'too "
      "stiff by 18 %' is a simulated force 18 % too large. Standard errors are clustered by press. "
      "A sentence is told only when pure noise would bring forth any in under 2 of 100 recordings; "
      "the largest is told first and taken off before the next is sought.",
      "The simulated file must have the rows of the measured one in the same order: presses, "
      "contact points and displacements are checked to 0.01 mm.",
      "On a terminal the residuals themselves are not printed unless asked for with -o.",
      "With --follow a stream of rows is compared with a model as they come. The usual error is "
      "learned at the beginning; then a cumulative sum of it raises an alarm, tuned to the false "
      "alarms an hour that are put up with. What follows the alarm tells whether the body has "
      "moved "
      "or is gone, its stiffness has changed or the sensor's zero has; the model goes on with "
      "that, "
      "without a jump in the force. A shift is told by three presses; where other sides are "
      "pressed "
      "later it is told better, by another alarm."};
  spec.options = {
      {.flag = "--simulated",
       .kind = OptionKind::kFile,
       .value = "[NAME=]FILE",
       .help = "Simulated forces of the same rows, from hs-simulate ('-': standard input). Given "
               "several times, the last is compared and the others are drawn beside it.",
       .repeatable = true},
      {.flag = "--html",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Writes the report: one file that needs no network."},
      {.flag = "--figures",
       .kind = OptionKind::kFile,
       .value = "PREFIX",
       .help = "Writes the plots as SVG files for papers: PREFIXversions.svg, PREFIXresidual-1.svg "
               "..., PREFIXpress-ID.svg of the six presses with the largest error."},
      {.flag = "--json",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Writes numbers, observations and breakdowns as JSON."},
      {.flag = "--body",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help =
           "Body from hs-tetmesh, or a surface (PLY, STL), for --ply and the report's picture."},
      {.flag = "--ply",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help =
           "Writes the body's surface coloured by the local error (vertex properties red, green, "
           "blue, and float error [N], NaN where nothing was pressed near). Needs --body."},
      {.flag = "--reach",
       .kind = OptionKind::kNumber,
       .value = "M",
       .help = "How far from a pressed position the surface is coloured [m]; otherwise one and a "
               "half times the usual distance between positions.",
       .minimum = 1e-6,
       .maximum = 10},
      {.flag = "--history",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "CSV of model versions and their errors (any columns; step, model, effects, rmse, "
               "heldout, noise are known), shown in the report."},
      {.flag = "--diagnosis",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "effects.csv from hs-diagnose, shown in the report; NAME=FILE names the model "
               "version it belongs to, and may be repeated. The last one gives the verdict.",
       .repeatable = true},
      {.flag = "--model",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "model.csv of the compared version: the report shows its parameters with their "
               "intervals, and its regions on the body. With --follow the model that the stream is "
               "compared with."},
      {.flag = "--junit",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Writes the verdict of --fail-above as JUnit's XML, for CI servers."},
      {.flag = "--title",
       .kind = OptionKind::kText,
       .value = "TEXT",
       .help = "Title of the report."},
      {.flag = "--fail-above",
       .kind = OptionKind::kText,
       .value = "X",
       .help = "Exit code 1 when the typical error exceeds X: 0.05N, 5% (of the force's rms), or "
               "1.5noise."}};
  for (const Option& option : follow_flags()) spec.options.push_back(option);
  spec.tables = {{"Residuals (output)",
                  {{"...", "the columns of the measured recording"},
                   {"sx, sy, sz", "simulated force [N]"},
                   {"rx, ry, rz", "measured minus simulated force [N]"}}}};
  spec.examples = {
      {"hs-compare data.csv --simulated forces.csv -o residuals.csv", "Residuals and a summary."},
      {"hs-simulate data.csv --body body.ply --model m0.csv | hs-compare data.csv --simulated - "
       "--body body.ply --html report.html -o residuals.csv",
       "The report, from a model at once."},
      {"hs-compare data.csv --simulated m0=f0.csv --simulated m1=f1.csv --history history.csv "
       "--diagnosis effects.csv --html report.html -o residuals.csv",
       "Two model versions in one report."},
      {"hs-compare data.csv --simulated forces.csv --fail-above 1.5noise -q -o residuals.csv",
       "A check in CI."}};
  spec.examples.push_back(
      {"hs-compare --follow - --body body.ply --model m.csv --events changes.csv",
       "Watches a robot's stream."});
  spec.see_also = {"hs-simulate(1)", "hs-diagnose(1)", "hs-identify(1)"};
  return spec;
}

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
  if (!number || limit.factor < 0 || (limit.unit == Limit::Unit::kNewton && unit != "N"))
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

// The outer surface of a body, or the surface itself.
Surface read_outside(const std::string& path) {
  Input input(path);
  const std::string bytes = input.read_all();
  const std::string head = bytes.substr(0, bytes.find("end_header"));
  Input again = Input::from_bytes(bytes, input.name());
  if (head.rfind("ply", 0) == 0 && head.find("element tetrahedron") != head.npos)
    return boundary_surface(read_body(again));
  return read_surface(again);
}

PlyFile coloured_ply(const ErrorMap& map, double top) {
  const auto column = [](const char* name, PlyType type) {
    PlyProperty property;
    property.name = name;
    property.type = type;
    return property;
  };
  PlyElement vertex{"vertex", map.surface.vertices.size(), {}};
  for (const char* name : {"x", "y", "z"})
    vertex.properties.push_back(column(name, PlyType::kFloat64));
  for (const char* name : {"red", "green", "blue"})
    vertex.properties.push_back(column(name, PlyType::kUint8));
  vertex.properties.push_back(column("error", PlyType::kFloat32));
  for (std::size_t i = 0; i < vertex.count; ++i) {
    const bool known = map.distance[i] <= map.reach;
    const Rgb colour = known ? error_colour(map.error[i] / top) : kUnknownColour;
    for (std::size_t k = 0; k < 3; ++k) {
      vertex.properties[k].values.push_back(map.surface.vertices[i][static_cast<Eigen::Index>(k)]);
      vertex.properties[3 + k].values.push_back(colour[k]);
    }
    vertex.properties[6].values.push_back(known ? map.error[i]
                                                : std::numeric_limits<double>::quiet_NaN());
  }
  PlyElement face{"face", map.surface.faces.size(), {column("vertex_indices", PlyType::kInt32)}};
  PlyProperty& corners = face.properties[0];
  corners.is_list = true;
  corners.offset.push_back(0);
  for (const Triangle& f : map.surface.faces) {
    corners.values.insert(corners.values.end(), f.begin(), f.end());
    corners.offset.push_back(corners.values.size());
  }
  PlyFile file;
  file.comments.push_back(
      fmt::format("error: rmse of nearby presses [N], colours from 0 to {:.4g}", top));
  file.elements = {vertex, face};
  return file;
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
  line(
      fmt::format("rmse {} over {} rows, x y z pooled (x {:.3g}, y {:.3g}, z {:.3g}); {} of the "
                  "force's rms, {} of its peak {}",
                  newtons(c.size.rmse), measured.rows(), c.size.rmse_axis[0], c.size.rmse_axis[1],
                  c.size.rmse_axis[2], percent_of(c.size.rmse, c.size.force_rms),
                  percent_of(c.size.rmse, c.size.force_peak), newtons(c.size.force_peak)));
  line(fmt::format("sensor noise {} ({}): the error is {} times that", newtons(c.noise.value),
                   c.noise.estimated ? "estimated from second differences in time: there is no "
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
    map = map_error(read_outside(arguments.text("--body")), c.facts.positions, error,
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
  if (arguments.given("--ply")) {
    double top = 2 * c.noise.value;  // an error as small as the noise must not look alarming
    for (const BinError& e : c.by_position().errors) top = std::max(top, e.rmse);
    write_ply(open(arguments.text("--ply")), coloured_ply(map, top > 0 ? top : 1));
  }
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
  say(arguments, "hs-compare", excess);
  return static_cast<int>(ExitCode::kCheckFailed);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
