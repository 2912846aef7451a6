// hs-simulate: the forces of a model along a motion.
#include <fmt/format.h>

#include "base/error.h"
#include "base/random.h"
#include "common_options.h"
#include "io/csv.h"
#include "model/edit.h"
#include "model/forces.h"
#include "model/full_simulation.h"
#include "realtime/live_session.h"
#include "realtime/real_time.h"

namespace hapsim {
namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-simulate";
  spec.summary = "contact forces of a model along a motion";
  spec.input = "motion or recording CSV (press,t,x,y,z,ux,uy,uz; forces in it are ignored)";
  spec.description = {
      "Writes the recording with the forces replaced by the model's. Each contact position is "
      "solved on second-order tetrahedra graded to the tool's rim; relaxation is integrated "
      "exactly for motion that is straight between samples "
      "and for any time steps.",
      "Measured and simulated recordings have one format, so the output feeds hs-compare and "
      "hs-identify alike.",
      "With --live every motion line is answered by its force line at once, from a body prepared "
      "beforehand: its surface condensed to stiffnesses, put right to those of --contacts and "
      "interpolated in between. The header comes first, and comes back when the body is ready. "
      "Lines are press,t,x,y,z,ux,uy,uz[,contact], or t,x,y,z, the positions of the tool's tip, of "
      "which contacts are found. At the positions of --contacts the forces are those of the batch "
      "mode (to 1e-6 of the largest). Models of elastic, regions and viscoelastic effects run "
      "live.",
      "With --full finite elements are solved at every step, tool and body as they are: a body of "
      "hyperelastic (finite) at finite strain, a tip of the effect tip as a ball whose contact "
      "grows, friction on the contact itself, relaxation in every element. It takes seconds a step "
      "and is what the quick laws are judged by. Several tools press one body at once with a "
      "column tool_id: rows of one press and time, one a tool, are one step."};
  spec.options = workspace_flags();
  spec.options.push_back({.flag = "--model",
                          .kind = OptionKind::kFile,
                          .value = "FILE",
                          .help = "Model from hs-identify.",
                          .required = true});
  spec.options.push_back({.flag = "--add-noise",
                          .kind = OptionKind::kNumber,
                          .value = "N",
                          .help = "Adds Gaussian noise of this standard deviation [N] to every "
                                  "force component and declares it as force_noise.",
                          .minimum = 0});
  spec.options.push_back({.flag = "--seed",
                          .kind = OptionKind::kInteger,
                          .value = "N",
                          .help = "Seed of the added noise.",
                          .default_text = "1",
                          .minimum = 0});
  spec.options.push_back({.flag = "--live",
                          .kind = OptionKind::kSwitch,
                          .help = "Answers each line as it comes; latencies on standard error."});
  spec.options.push_back({.flag = "--contacts",
                          .kind = OptionKind::kFile,
                          .value = "FILE",
                          .help = "Live: a recording whose contact positions are solved finely "
                                  "before the first line."});
  spec.options.push_back({.flag = "--rate",
                          .kind = OptionKind::kNumber,
                          .value = "HZ",
                          .help = "Live: takes the lines at this rate by the clock, with memory "
                                  "locked and real-time scheduling where they are permitted.",
                          .minimum = 0.001,
                          .maximum = 100000});
  spec.options.push_back({.flag = "--full",
                          .kind = OptionKind::kSwitch,
                          .help = "Finite elements at every step; a step that does not converge "
                                  "ends it (exit 4)."});
  spec.options.push_back({.flag = "--own-mesh",
                          .kind = OptionKind::kSwitch,
                          .help = "Full: on the body's own mesh; otherwise each press on one "
                                  "graded to its tool's rim."});
  spec.options.push_back({.flag = "--force-control",
                          .kind = OptionKind::kSwitch,
                          .help = "Full: the motion's forces are given, its displacements are "
                                  "found and written."});
  spec.examples = {
      {"hs-simulate data.csv --body body.ply --model m0.csv -o forces.csv", "Forces of a model."},
      {"hs-simulate data.csv --body body.ply --model m0.csv | hs-compare data.csv --simulated -",
       "Where the model fails."},
      {"hs-simulate --live --rate 1000 motion.csv --contacts data.csv --body body.ply --model "
       "m0.csv",
       "A recorded motion at 1 kHz."},
      {"hs-simulate --full data.csv --body body.ply --model m2.csv | hs-compare data.csv "
       "--simulated -",
       "A model with finite strain and a round tip, without its quick laws."}};
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-diagnose(1)"};
  return spec;
}

// The finely solved contacts of --contacts; none without.
std::vector<KnownStiffness> solved_contacts(const Arguments& arguments, const TetMesh& body,
                                            const Model& model) {
  if (!arguments.given("--contacts")) return {};
  std::shared_ptr<Progress> progress;
  WorkspaceOptions options = workspace_options(arguments, progress);
  set_poisson_range(model, options);
  Workspace w =
      make_workspace(body, load_recording(arguments, arguments.text("--contacts"), false), options);
  progress.reset();
  w.body->solve(material_of(model));
  return known_contacts(*w.body, material_of(model));
}

double live_radius(const Arguments& arguments, const MotionLines& lines) {
  if (arguments.given("--tool-radius")) return arguments.number("--tool-radius");
  const auto radius = lines.metadata().number("tool_radius", arguments.input());
  if (!radius || !(*radius > 0))
    fail_usage("the motion does not say its tool's radius", "give --tool-radius M [m]");
  return *radius;
}

int run_live_mode(const Arguments& arguments) {
  if (arguments.given("--add-noise"))
    fail_usage("--add-noise is of the batch mode", "leave it out, or --live");
  Input model_input(arguments.text("--model"));
  const Model model = read_model(model_input);
  const TetMesh mesh = load_body(arguments);
  Input input(arguments.input());
  MotionLines lines(input);
  PreparedBodyOptions options;
  options.tool_radius = live_radius(arguments, lines);
  options.contacts = solved_contacts(arguments, mesh, model);
  const std::int64_t start = monotonic_ns();
  const PreparedBody body(mesh, model, options);
  say(arguments, "hs-simulate",
      fmt::format("{} surface unknowns condensed in {:.1f} ms, {} contacts solved finely",
                  body.surface_unknowns(), 1e-6 * static_cast<double>(monotonic_ns() - start),
                  options.contacts.size()));

  LiveOptions live;
  if (arguments.has("--rate")) live.rate = arguments.number("--rate");
  live.loop.relaxed = lines.metadata().find("recovery").value_or("") != "none";
  if (live.rate > 0) say(arguments, "hs-simulate", enter_real_time());
  Metadata metadata = lines.metadata();
  metadata.remove("force_noise");
  metadata.set("simulated", effects_label(model));
  Output output(arguments.output());
  CsvWriter(output.stream(), metadata, kForceColumns);
  output.stream().flush();
  LiveReport report;
  const auto tell = [&] {
    std::string text = report.latency.summary();
    if (live.rate > 0)
      text += fmt::format("; {} of {} later than a period", report.misses, report.latency.count());
    say(arguments, "hs-simulate", text);
  };
  try {
    run_live(lines, output.stream(), body, live, report);
  } catch (const Error&) {
    output.commit();  // the forces before a bad line stay
    tell();
    throw;
  }
  output.commit();
  tell();
  return 0;
}

// Noise as asked for, metadata, and out.
void write_simulated(const Arguments& arguments, const Model& model, Recording& out) {
  out.metadata.remove("force_noise");
  out.metadata.set("simulated", effects_label(model));
  if (arguments.given("--add-noise")) {
    const double noise = arguments.number("--add-noise");
    Random random(static_cast<std::uint64_t>(arguments.integer("--seed")));
    for (Vec3& force : out.f)
      for (int k = 0; k < 3; ++k) force[k] += noise * random.normal();
    out.metadata.set("force_noise", format_number(noise));
    out.metadata.set("seed", arguments.text("--seed"));
  }
  Output output(arguments.output());
  write_recording(output.stream(), out);
  output.commit();
}

int run_full_mode(const Arguments& arguments) {
  Input model_input(arguments.text("--model"));
  const Model model = read_model(model_input);
  const TetMesh body = load_body(arguments);
  FullOptions options;
  options.own_mesh = arguments.given("--own-mesh");
  options.force_control = arguments.given("--force-control");
  if (arguments.given("--rim-edge")) options.rim_edge = arguments.number("--rim-edge");
  Recording out = load_recording(arguments, arguments.input(), options.force_control);
  Progress progress(arguments, "rows", out.rows());
  options.step = [&progress](std::size_t rows) { progress.step(rows); };
  FullResult result = simulate_full(body, model, out, options);
  out.f = std::move(result.force);
  out.u = std::move(result.motion);
  write_simulated(arguments, model, out);
  say(arguments, "hs-simulate",
      fmt::format("{} rows by finite elements, up to {} unknowns, {} Newton steps, model {}",
                  out.rows(), result.unknowns, result.newton_steps, effects_label(model)));
  return 0;
}

int run(const Arguments& arguments) {
  if (arguments.given("--live") && arguments.given("--full"))
    fail_usage("--live and --full exclude each other", "leave one of them out");
  if (arguments.given("--live")) return run_live_mode(arguments);
  for (const char* flag : {"--rate", "--contacts"})
    if (arguments.given(flag))
      fail_usage(std::string(flag) + " is of the live mode", "add --live, or leave it out");
  if (arguments.given("--full")) return run_full_mode(arguments);
  for (const char* flag : {"--own-mesh", "--force-control"})
    if (arguments.given(flag))
      fail_usage(std::string(flag) + " is of the full mode", "add --full, or leave it out");
  Input model_input(arguments.text("--model"));
  const Model model = read_model(model_input);
  const TetMesh body = load_body(arguments);
  std::shared_ptr<Progress> progress;
  WorkspaceOptions options = workspace_options(arguments, progress);
  set_poisson_range(model, options);  // as hs-identify did, so its prepared stiffnesses serve again
  Workspace w = make_workspace(body, load_recording(arguments, arguments.input(), false), options);
  progress.reset();
  w.body->solve(material_of(model));
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd f = model_forces(model, w.dataset, all, *w.body, false).f;

  Recording out = w.dataset.recording;
  out.f.assign(out.rows(), Vec3::Zero());
  const std::vector<int> rows = stacked_rows(w.dataset, all);
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.f[rows[i]] = f.segment<3>(3 * static_cast<Eigen::Index>(i));
  write_simulated(arguments, model, out);
  say(arguments, "hs-simulate",
      fmt::format("{} rows, {} positions, model {}, mesh uncertainty {:.2f} %", out.rows(),
                  w.dataset.positions.size(), effects_label(model),
                  100 * w.body->mesh_uncertainty()));
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
