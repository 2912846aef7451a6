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
#include "model/full_simulation.h"
#include "model/own_mesh.h"
#include "model/regional_relaxation.h"
#include "realtime/live_session.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
#include "realtime/real_time.h"
#include "simulate_specification.h"

namespace hapsim {
namespace {

// The positions of --contacts, to be solved finely for any material. `progress` must outlive it.
std::optional<Workspace> fine_contacts(const Arguments& arguments, const TetMesh& body,
                                       const Model& model, std::shared_ptr<Progress>& progress) {
  if (!arguments.given("--contacts")) return std::nullopt;
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
  const Model model = load_model(arguments, "hs-simulate");
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
  std::shared_ptr<Progress> progress;
  const std::optional<Workspace> fine = fine_contacts(arguments, mesh, model, progress);
  progress.reset();
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

void write_forces(const Arguments& arguments, const Model& model, const Dataset& dataset,
                  const Selection& all, const Eigen::VectorXd& f, double mesh_uncertainty = 0) {
  Recording out = dataset.recording;
  out.metadata.remove("mesh_uncertainty");
  if (mesh_uncertainty > 0)
    out.metadata.set("mesh_uncertainty", fmt::format("{:.2g}", mesh_uncertainty));
  out.f.assign(out.rows(), Vec3::Zero());
  const std::vector<int> rows = stacked_rows(dataset, all);
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.f[rows[i]] = f.segment<3>(3 * static_cast<Eigen::Index>(i));
  write_simulated(arguments, model, out);
}

int run_full_mode(const Arguments& arguments) {
  const Model model = load_model(arguments, "hs-simulate");
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

int run_own_mesh(const Arguments& arguments) {
  const Model model = load_model(arguments, "hs-simulate");
  const TetMesh mesh = load_body(arguments);
  Dataset dataset = make_dataset(load_recording(arguments, arguments.input(), false));
  std::vector<FieldRow> fields;
  if (arguments.given("--vtu"))
    fields = field_rows(dataset, arguments.given("--rows") ? arguments.text("--rows") : "");
  const OwnMesh body(mesh, model, dataset.positions, dataset.recording.tool_radius(),
                     solver_kind(arguments));
  if (arguments.given("--vtu") && body.is_regional())
    fail_usage("the field of regions that relax each in its own way is not written",
               "leave out --vtu, or give all of them the terms of region 0");
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

// Each position on its own graded mesh.
Eigen::VectorXd contact_mesh_forces(const Arguments& arguments, const Model& model,
                                    const Workspace& w, const Selection& all) {
  const MaterialSpec material = material_of(model);
  const std::vector<RegionRelaxation> regions = regional_relaxation_of(model, material);
  if (regions.empty()) {
    w.body->solve(material);
    return model_forces(model, w.dataset, all, *w.body, false).f;
  }
  const auto solve = [&](const MaterialSpec& sample) {
    w.body->solve(sample);
    std::vector<Eigen::Matrix3d> K;
    for (std::size_t p = 0; p < w.dataset.positions.size(); ++p)
      K.push_back(w.body->at(p, sample).K);
    return K;
  };
  double misfit = 0;
  const std::vector<PositionStiffness> stiffness =
      regional_stiffness(regions, material, solve, misfit);
  say(arguments, "hs-simulate",
      fmt::format("regions relax each in its own way: {} Maxwell elements, within {:.1g} of the "
                  "stiffness",
                  stiffness.front().relaxing.size(), misfit));
  const auto at = [&](std::size_t p) { return stiffness[p]; };
  return model_forces(model, w.dataset, all, at, false).f;
}

int run(const Arguments& arguments) {
  if (arguments.given("--own-mesh") && arguments.given("--live"))
    fail_usage("--own-mesh is of the batch mode", "leave out --live or --own-mesh");
  if (arguments.given("--full") && arguments.given("--live"))
    fail_usage("--live and --full exclude each other", "leave one of them out");
  for (const char* flag : {"--vtu", "--rows", "--solver"}) {
    if (arguments.given(flag) && !arguments.given("--own-mesh"))
      fail_usage(std::string(flag) + " is of the body's own mesh",
                 "add --own-mesh, or leave it out");
    if (arguments.given(flag) && arguments.given("--full"))
      fail_usage(std::string(flag) + " is not of the full mode", "leave it out");
  }
  if (arguments.given("--force-control") && !arguments.given("--full"))
    fail_usage("--force-control is of the full mode", "add --full, or leave it out");
  if (arguments.given("--rows") && !arguments.given("--vtu"))
    fail_usage("--rows says which fields --vtu writes", "add --vtu PREFIX, or leave it out");
  if (arguments.given("--live")) return run_live_mode(arguments);
  for (const char* flag : {"--rate", "--contacts", "--binary"})
    if (arguments.given(flag))
      fail_usage(std::string(flag) + " is of the live mode", "add --live, or leave it out");
  if (arguments.given("--full")) return run_full_mode(arguments);
  if (arguments.given("--own-mesh")) return run_own_mesh(arguments);
  const Model model = load_model(arguments, "hs-simulate");
  const TetMesh body = load_body(arguments);
  std::shared_ptr<Progress> progress;
  WorkspaceOptions options = workspace_options(arguments, progress);
  set_poisson_range(model, options);  // as hs-identify did, so its prepared stiffnesses serve again
  Workspace w = make_workspace(body, load_recording(arguments, arguments.input(), false), options);
  progress.reset();
  const Selection all = all_episodes(w.dataset);
  write_forces(arguments, model, w.dataset, all, contact_mesh_forces(arguments, model, w, all),
               w.body->mesh_uncertainty());
  say(arguments, "hs-simulate",
      fmt::format("{} rows, {} positions, model {}, mesh uncertainty {:.2f} %", w.dataset.rows(),
                  w.dataset.positions.size(), effects_label(model),
                  100 * w.body->mesh_uncertainty()));
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::simulate_specification(), argc, argv, hapsim::run);
}
