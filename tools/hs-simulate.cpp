// hs-simulate: the forces of a model along a motion.
#include <fmt/format.h>

#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "common_options.h"
#include "io/csv.h"
#include "model/edit.h"
#include "model/field_rows.h"
#include "model/forces.h"
#include "model/own_mesh.h"
#include "realtime/live_session.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
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
      "live; there, rows of the viscoelastic effect with a region above 0 give each region its own "
      "Maxwell elements.",
      "With --binary, motion and forces are records of fixed size, little-endian, without header "
      "or "
      "padding: i is an integer of 32 bits, the others are numbers of 64 bits (IEEE 754) in SI "
      "units. In, tip (32 bytes): t x y z; press (64 bytes): i press, i contact (0: in the air), t "
      "x "
      "y z ux uy uz. Out (88 bytes): i press, i contact, t x y z ux uy uz fx fy fz. Give "
      "--tool-radius.",
      "With --own-mesh nothing is meshed: the body's own tetrahedra, of either order, are pressed "
      "at the nodes under the tool, by a sparse factorisation or by conjugate gradients, whichever "
      "is faster for the size (it says which). The force is as good as that mesh is fine there."};
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
  spec.options.push_back(
      {.flag = "--own-mesh",
       .kind = OptionKind::kSwitch,
       .help = "Presses the body's own mesh instead of meshes of its contacts."});
  spec.options.push_back({.flag = "--solver",
                          .kind = OptionKind::kChoice,
                          .value = "NAME",
                          .help = "Own mesh: how it is solved.",
                          .default_text = "by-size",
                          .choices = {"by-size", "direct", "iterative"}});
  spec.options.push_back({.flag = "--vtu",
                          .kind = OptionKind::kText,
                          .value = "PREFIX",
                          .help =
                              "Own mesh: writes PREFIX-ROW.vtu with displacement, stress and "
                              "energy density at the deepest row of each press, or at --rows."});
  spec.options.push_back({.flag = "--rows",
                          .kind = OptionKind::kText,
                          .value = "LIST",
                          .help = "Rows of the motion to write with --vtu, from 1: 20,40,60."});
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
  spec.options.push_back({.flag = "--binary",
                          .kind = OptionKind::kChoice,
                          .value = "KIND",
                          .help = "Live: records instead of lines in and out; tip positions or "
                                  "presses come in.",
                          .choices = {"tip", "press"}});
  spec.examples = {
      {"hs-simulate data.csv --body body.ply --model m0.csv -o forces.csv", "Forces of a model."},
      {"hs-simulate data.csv --body body.ply --model m0.csv | hs-compare data.csv --simulated -",
       "Where the model fails."},
      {"hs-simulate --live --rate 1000 motion.csv --contacts data.csv --body body.ply --model "
       "m0.csv",
       "A recorded motion at 1 kHz."}};
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-diagnose(1)"};
  return spec;
}

// The positions of --contacts, to be solved finely for any material.
std::optional<Workspace> fine_contacts(const Arguments& arguments, const TetMesh& body,
                                       const Model& model) {
  if (!arguments.given("--contacts")) return std::nullopt;
  std::shared_ptr<Progress> progress;
  WorkspaceOptions options = workspace_options(arguments, progress);
  set_poisson_range(model, options);
  return make_workspace(body, load_recording(arguments, arguments.text("--contacts"), false),
                        options);
}

double live_radius(const Arguments& arguments, const Metadata& metadata) {
  if (arguments.given("--tool-radius")) return arguments.number("--tool-radius");
  const auto radius = metadata.number("tool_radius", arguments.input());
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
  std::unique_ptr<MotionSource> source;
  Metadata metadata;  // binary motion has none
  const bool binary = arguments.given("--binary");
  if (binary) {
    source = std::make_unique<MotionRecords>(input, arguments.text("--binary") == "tip"
                                                        ? MotionRecords::Kind::kTip
                                                        : MotionRecords::Kind::kPress);
  } else {
    auto lines = std::make_unique<MotionLines>(input);
    metadata = lines->metadata();
    source = std::move(lines);
  }
  PreparedBodyOptions options;
  options.tool_radius = live_radius(arguments, metadata);
  const std::optional<Workspace> fine = fine_contacts(arguments, mesh, model);
  if (fine)
    options.contacts = [&](const MaterialSpec& material) {
      fine->body->solve(material);
      return known_contacts(*fine->body, material);
    };
  const std::int64_t start = monotonic_ns();
  const PreparedBody body(mesh, model, options);
  say(arguments, "hs-simulate",
      fmt::format("{} surface unknowns condensed in {:.1f} ms, {} contacts solved finely",
                  body.surface_unknowns(), 1e-6 * static_cast<double>(monotonic_ns() - start),
                  fine ? fine->dataset.positions.size() : 0));
  if (body.is_regional())
    say(arguments, "hs-simulate",
        fmt::format("regions relax each in its own way: {} Maxwell elements, within {:.1g} of the "
                    "stiffness",
                    body.terms().size(), body.misfit()));

  LiveOptions live;
  if (arguments.has("--rate")) live.rate = arguments.number("--rate");
  live.loop.relaxed = metadata.find("recovery").value_or("") != "none";
  if (live.rate > 0) say(arguments, "hs-simulate", enter_real_time());
  metadata.remove("force_noise");
  metadata.set("simulated", effects_label(model));
  Output output(arguments.output());
  if (!binary) CsvWriter(output.stream(), metadata, kForceColumns);
  output.stream().flush();
  LiveReport report;
  const auto tell = [&] {
    std::string text = report.latency.summary();
    if (live.rate > 0)
      text += fmt::format("; {} of {} later than a period", report.misses, report.latency.count());
    say(arguments, "hs-simulate", text);
  };
  try {
    run_live(*source, output.stream(), body, live, report);
  } catch (const Error&) {
    output.commit();  // the forces before a bad line stay
    tell();
    throw;
  }
  output.commit();
  tell();
  return 0;
}

SolverKind solver_kind(const Arguments& arguments) {
  const std::string name = arguments.text("--solver");
  if (name == "direct") return SolverKind::kDirect;
  return name == "iterative" ? SolverKind::kIterative : SolverKind::kBySize;
}

void write_forces(const Arguments& arguments, const Model& model, const Dataset& dataset,
                  const Selection& all, const Eigen::VectorXd& f) {
  Recording out = dataset.recording;
  out.f.assign(out.rows(), Vec3::Zero());
  const std::vector<int> rows = stacked_rows(dataset, all);
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.f[rows[i]] = f.segment<3>(3 * static_cast<Eigen::Index>(i));
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

int run_own_mesh(const Arguments& arguments) {
  Input model_input(arguments.text("--model"));
  const Model model = read_model(model_input);
  const TetMesh mesh = load_body(arguments);
  Dataset dataset = make_dataset(load_recording(arguments, arguments.input(), false));
  std::vector<FieldRow> fields;
  if (arguments.given("--vtu"))
    fields = field_rows(dataset, arguments.given("--rows") ? arguments.text("--rows") : "");
  const OwnMesh body(mesh, model, dataset.positions, dataset.recording.tool_radius(),
                     solver_kind(arguments));
  set_normals(dataset, body.normals());
  const Selection all = all_episodes(dataset);
  const auto stiffness_at = [&](std::size_t p) { return body.at(p); };
  write_forces(arguments, model, dataset, all,
               model_forces(model, dataset, all, stiffness_at, false).f);
  for (const FieldRow& row : fields) {
    Output output(fmt::format("{}-{}.vtu", arguments.text("--vtu"), row.row + 1));
    body.write_field(output.stream(), dataset.episodes[row.episode], row.sample);
    output.commit();
  }
  say(arguments, "hs-simulate",
      fmt::format("{} rows, {} positions on {} tetrahedra, {} nodes under the tool; {}",
                  dataset.rows(), dataset.positions.size(), mesh.tets.size(), body.patch_size(0),
                  body.solver().why));
  return 0;
}

int run(const Arguments& arguments) {
  if (arguments.given("--own-mesh") && arguments.given("--live"))
    fail_usage("--own-mesh is of the batch mode", "leave out --live or --own-mesh");
  for (const char* flag : {"--vtu", "--rows", "--solver"})
    if (arguments.given(flag) && !arguments.given("--own-mesh"))
      fail_usage(std::string(flag) + " is of the body's own mesh",
                 "add --own-mesh, or leave it out");
  if (arguments.given("--rows") && !arguments.given("--vtu"))
    fail_usage("--rows says which fields --vtu writes", "add --vtu PREFIX, or leave it out");
  if (arguments.given("--live")) return run_live_mode(arguments);
  for (const char* flag : {"--rate", "--contacts", "--binary"})
    if (arguments.given(flag))
      fail_usage(std::string(flag) + " is of the live mode", "add --live, or leave it out");
  if (arguments.given("--own-mesh")) return run_own_mesh(arguments);
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
  write_forces(arguments, model, w.dataset, all,
               model_forces(model, w.dataset, all, *w.body, false).f);
  say(arguments, "hs-simulate",
      fmt::format("{} rows, {} positions, model {}, mesh uncertainty {:.2f} %", w.dataset.rows(),
                  w.dataset.positions.size(), effects_label(model),
                  100 * w.body->mesh_uncertainty()));
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
