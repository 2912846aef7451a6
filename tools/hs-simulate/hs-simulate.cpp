// hs-simulate: the forces of a model along a motion.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>

#include "acfm/acfm_fit.h"
#include "answer.h"
#include "base/counted.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "common_options.h"
#include "experiment/fitted_range.h"
#include "experiment/forces.h"
#include "experiment/unseen_band.h"
#include "hs-simulate/flags.h"
#include "hs-simulate/live.h"
#include "hs-simulate/specification.h"
#include "io/csv.h"
#include "marked_points.h"
#include "model/model_edit.h"
#include "simulate/field_rows.h"
#include "simulate/full_simulation.h"
#include "simulate/own_mesh.h"
#include "simulate/simulate.h"
#include "simulate/traction.h"

namespace hapsim {
namespace {

SolverKind solver_kind(const Arguments& arguments) {
  const std::string name = arguments[flag::solver];
  if (name == "direct") return SolverKind::kDirect;
  return name == "iterative" ? SolverKind::kIterative : SolverKind::kBySize;
}

void say_beyond(const Arguments& arguments, const PressDepth& depth, const Model& model) {
  const std::string text = beyond_depth(depth, model);
  if (!text.empty()) say(arguments, "hs-simulate", text);
}

// Noise as asked for, metadata, and out.
void write_simulated(const Arguments& arguments, const std::string& label, Recording& out,
                     const UnseenBand& band = {}) {
  mark_simulated(out.metadata, label);
  record_band(band, out.metadata);  // none is left from another model
  if (arguments.given(flag::add_noise))
    add_noise(out, arguments[flag::add_noise], static_cast<std::uint64_t>(arguments[flag::seed]));
  if (arguments.given(flag::torque_noise))
    add_torque_noise(out, arguments[flag::torque_noise],
                     static_cast<std::uint64_t>(arguments[flag::seed]));
  Output output(result_file(arguments));
  write_recording(output.stream(), out);
  output.commit();
}

// How far the model may be off at places that it was not fitted to, and how many these are.
UnseenBand tell_unseen(const Model& model, const Recording& out, Summary& summary) {
  const UnseenBand band = recorded_band(model.metadata, model.name);
  const FittedRange range = fitted_range(model.metadata, model.name);
  if (!band.known() || range.places.empty()) return {};
  const double near = std::max(out.tool_radius() / 2, range.covers);
  std::set<std::array<double, 3>> places, others;
  for (const Vec3& p : out.position) {
    if (!places.insert({p.x(), p.y(), p.z()}).second) continue;
    const auto here = [&](const Vec3& q) { return (p - q).norm() <= near; };
    if (std::none_of(range.places.begin(), range.places.end(), here))
      others.insert({p.x(), p.y(), p.z()});
  }
  if (others.empty()) return {};
  summary.items.push_back(
      {"UNSEEN",
       "",
       "",
       {fmt::format("of {} {} not among those that the model was fitted to; {}",
                    counted(places.size(), "place", "places"), others.size(), band_words(band))}});
  summary.values.push_back({"unseen_places", static_cast<double>(others.size()), "1"});
  summary.values.push_back({"unseen_band", band.share, "1"});
  summary.values.push_back({"unseen_chance", band.chance, "1"});
  return band;
}

// Other modes have forces alone: measured torques are not to pass for simulated ones.
void leave_torques(const Arguments& arguments, Recording& out) {
  const std::string words = without_torques(out, "this mode has forces alone");
  if (!words.empty()) say(arguments, "hs-simulate", words);
}

// Forces of how many rows (with --force-control displacements), and a comparison with what was
// measured, where the motion has that.
Summary simulated_summary(const Arguments& arguments, std::size_t rows, const std::string& label,
                          bool measured) {
  Summary s;
  s.verdict =
      fmt::format("{}: {} of {}", arguments.input() == "-" ? "standard input" : arguments.input(),
                  arguments[flag::force_control] ? "displacements" : "forces", label);
  s.size = counted(static_cast<std::ptrdiff_t>(rows), "row", "rows");
  s.values = {{"rows", static_cast<double>(rows), "1"}};
  if (!measured || arguments.output() == "-" || arguments.input() == "-" ||
      arguments.given(flag::add_noise))
    return s;
  s.next = fmt::format("hs-compare {} --simulated {}", shell_quoted(arguments.input()),
                       shell_quoted(arguments.output()));
  for (const AnyFlag& flag : AnyFlags{flag::body, flag::model})
    if (arguments.given(flag)) s.next += " " + flag + " " + shell_quoted(arguments.text(flag));
  s.next += " --html report.html -o residuals.csv";
  return s;
}

int run_full_mode(const Arguments& arguments, const Model& model) {
  const TetMesh body = load_body(arguments);
  say_idle(arguments, "hs-simulate", model, body);
  FullOptions options;
  options.own_mesh = arguments[flag::own_mesh];
  options.force_control = arguments[flag::force_control];
  if (arguments.given(flag::rim_edge)) options.rim_edge = arguments[flag::rim_edge];
  Recording out = load_recording(arguments, arguments.input(), options.force_control);
  const bool measured = !out.f.empty();
  if (!options.force_control) say_beyond(arguments, press_depth(body, out), model);
  Progress progress(arguments, "rows", out.rows());
  options.step = [&progress](std::size_t rows) { progress.step(rows); };
  FullResult result = simulate_full(body, model, out, options);
  out.f = std::move(result.force);
  out.u = std::move(result.motion);
  leave_torques(arguments, out);
  write_simulated(arguments, effects_label(model), out);
  Summary summary = simulated_summary(arguments, out.rows(), effects_label(model),
                                      measured && !options.force_control);
  summary.items = {{"SOLVED",
                    "",
                    "",
                    {fmt::format("{} rows by finite elements, up to {} unknowns, {} Newton steps",
                                 out.rows(), result.unknowns, result.newton_steps)}}};
  summary.values.push_back({"unknowns", static_cast<double>(result.unknowns), "1"});
  summary.values.push_back({"newton_steps", static_cast<double>(result.newton_steps), "1"});
  tell_answer(arguments, summary);
  return 0;
}

int run_own_mesh(const Arguments& arguments, const Model& model) {
  const TetMesh mesh = load_body(arguments);
  say_idle(arguments, "hs-simulate", model, mesh);
  const bool forces_given = arguments[flag::force_control];
  Recording motion = load_pressed(arguments, arguments.input(), forces_given, model);
  if (forces_given) motion.u.assign(motion.rows(), Vec3::Zero());  // not known yet
  Dataset dataset = make_dataset(std::move(motion));
  if (const double nu = material_of(model).nu; mesh.order == 1 && nu > 0.4)
    say(arguments, "hs-simulate",
        fmt::format("elements of first order are too stiff at nu {:g} where a body's own mesh is "
                    "pressed; mesh it with --order 2, or add --full",
                    nu));
  std::vector<FieldRow> fields;
  if (arguments.given(flag::vtu))
    fields = field_rows(dataset, arguments.given(flag::rows) ? arguments[flag::rows] : "");
  const OwnMesh body(mesh, model, dataset.positions, dataset.recording.disc_radius(),
                     solver_kind(arguments));
  if (arguments.given(flag::vtu) && body.is_regional())
    fail_input(model.name, "the field of regions that relax each in its own way is not written",
               "leave out --vtu, or give all of them the terms of region 0");
  dataset.label = body.labels();
  dataset = on_body(std::move(dataset), body.stands());
  if (!forces_given) say_beyond(arguments, press_depth(std::span(&mesh, 1), dataset), model);
  say_together(arguments, "hs-simulate", dataset.recording);
  const Selection all = all_episodes(dataset);
  const auto stiffness_at = [&](std::size_t p) { return body.at(p); };
  Recording out =
      forces_given
          ? with_displacements(model, dataset, stiffness_at)
          : with_forces(dataset, all, model_forces(model, dataset, stiffness_at, all, false).f);
  if (forces_given) say_beyond(arguments, press_depth(mesh, out), model);
  leave_torques(arguments, out);
  write_simulated(arguments, effects_label(model), out);
  for (const FieldRow& row : fields) {
    Output output(fmt::format("{}-{}.vtu", arguments[flag::vtu], row.row + 1));
    body.write_field(output.stream(), dataset.episodes[row.episode], row.sample);
    output.commit();
  }
  Summary summary = simulated_summary(arguments, dataset.rows(), effects_label(model),
                                      !forces_given && !dataset.recording.f.empty());
  summary.items = {
      {"SOLVED",
       "",
       "",
       {fmt::format(
           "{} rows, {} positions on {} tetrahedra, {} nodes under the tool; {}{}", dataset.rows(),
           dataset.positions.size(), mesh.tets.size(), body.patch_size(0), body.solver().why,
           body.iterations() > 0 ? fmt::format("; {} iterations", body.iterations()) : "")}}};
  summary.values.push_back({"positions", static_cast<double>(dataset.positions.size()), "1"});
  summary.values.push_back({"iterations", static_cast<double>(body.iterations()), "1"});
  summary.values.push_back({"nodes_under_tool", static_cast<double>(body.patch_size(0)), "1"});
  tell_answer(arguments, summary);
  return 0;
}

int run_acfm(const Arguments& arguments, const Acfm& model) {
  for (const AnyFlag& flag : AnyFlags{flag::full, flag::own_mesh, flag::force_control})
    if (arguments.given(flag))
      fail_usage(flag + " is of finite elements, and this model has none", "leave it out");
  const Dataset dataset = make_dataset(load_recording(arguments, arguments.input(), false));
  Recording out = dataset.recording;
  out.f = acfm_forces(model, dataset);
  leave_torques(arguments, out);
  write_simulated(arguments, "acfm", out);
  Summary summary =
      simulated_summary(arguments, dataset.rows(), "acfm", !dataset.recording.f.empty());
  summary.items = {
      {"SOLVED",
       "",
       "",
       {fmt::format("{} rows, {} positions, from {} sub-models of {} Maxwell elements a direction",
                    dataset.rows(), dataset.positions.size(), model.positions.size(),
                    model.terms)}}};
  summary.values.push_back({"positions", static_cast<double>(dataset.positions.size()), "1"});
  tell_answer(arguments, summary);
  return 0;
}

int run(const Arguments& arguments) {
  if (arguments.given(flag::json) && arguments[flag::live])
    fail_usage("--json is of the batch mode", "leave out --live or --json");
  if (arguments[flag::own_mesh] && arguments[flag::live])
    fail_usage("--own-mesh is of the batch mode", "leave out --live or --own-mesh");
  if (arguments.given(flag::calibration) && arguments[flag::live])
    fail_usage("--calibration is of recordings, and --live reads a stream",
               "leave out --live or --calibration");
  if (arguments[flag::full] && arguments[flag::live])
    fail_usage("--live and --full exclude each other", "leave one of them out");
  for (const AnyFlag& flag : AnyFlags{flag::vtu, flag::rows, flag::solver}) {
    if (arguments.given(flag) && !arguments[flag::own_mesh])
      fail_usage(flag + " is of the body's own mesh", "add --own-mesh, or leave it out");
    if (arguments.given(flag) && arguments[flag::full])
      fail_usage(flag + " is not of the full mode", "leave it out");
  }
  if (arguments[flag::force_control] && arguments[flag::live])
    fail_usage("--force-control is of the batch mode", "leave out --live or --force-control");
  if (arguments[flag::force_control] && arguments.given(flag::vtu))
    fail_usage("--vtu is of displacements that are given", "simulate the found motion with --vtu");
  if (arguments.given(flag::rows) && !arguments.given(flag::vtu))
    fail_usage("--rows says which fields --vtu writes", "add --vtu PREFIX, or leave it out");
  for (const AnyFlag& flag : AnyFlags{flag::torques, flag::torque_noise})
    for (const AnyFlag& mode :
         AnyFlags{flag::live, flag::own_mesh, flag::full, flag::force_control})
      if (arguments.given(flag) && arguments.given(mode))
        fail_usage(flag + " is of forces at prepared places, which " + mode + " does without",
                   "leave one of them out; the live mode has torques of a tool that turns, with "
                   "columns thx,thy,thz");
  for (const AnyFlag& flag : AnyFlags{flag::markers, flag::markers_out, flag::marker_noise}) {
    if (arguments.given(flag) &&
        !(arguments.given(flag::markers) && arguments.given(flag::markers_out)))
      fail_usage("--markers and --markers-out go together", "give both, or none");
    for (const AnyFlag& mode :
         AnyFlags{flag::live, flag::own_mesh, flag::full, flag::force_control})
      if (arguments.given(flag) && arguments.given(mode))
        fail_usage(flag + " is of meshes of the contacts, which " + mode + " does without",
                   "leave one of them out");
  }
  Input file(arguments[flag::model]);
  const std::string bytes = file.read_all();
  Input model_input = Input::from_bytes(bytes, file.name());
  std::optional<Acfm> acfm;
  Model model;
  if (is_acfm(bytes))
    acfm = read_acfm(model_input);
  else
    model = load_model(arguments, "hs-simulate", model_input);
  if (!acfm && !arguments.given(flag::body))
    fail_usage("--body is required", "give the body that the model is of");
  if (arguments[flag::live]) {
    if (acfm) return run_live_acfm(arguments, *acfm);
    return run_live_mode(arguments, model);
  }
  for (const AnyFlag& flag :
       AnyFlags{flag::rate, flag::contacts, flag::binary, flag::tools, flag::hand, flag::accuracy,
                flag::uncertainty, flag::large_strain})
    if (arguments.given(flag))
      fail_usage(flag + " is of the live mode", "add --live, or leave it out");
  hand_limits(arguments);
  if (acfm && (arguments.given(flag::torques) || arguments.given(flag::torque_noise)))
    fail_usage("torques are of finite elements, and this model has none", "leave out --torques");
  if (acfm && arguments.given(flag::markers))
    fail_usage("marked points are of finite elements, and this model has none",
               "leave out --markers");
  if (acfm) return run_acfm(arguments, *acfm);
  if (arguments[flag::full]) return run_full_mode(arguments, model);
  if (arguments[flag::own_mesh]) return run_own_mesh(arguments, model);
  const TetMesh body = load_body(arguments);
  say_idle(arguments, "hs-simulate", model, body);
  std::shared_ptr<Progress> progress;
  ExperimentOptions options = experiment_options(arguments, progress);
  const Control control = arguments[flag::force_control] ? Control::kForce : Control::kDisplacement;
  Recording motion = load_recording(arguments, arguments.input(), control == Control::kForce);
  const bool measured = control == Control::kDisplacement && !motion.f.empty();
  const std::optional<MarkerTable> points = asked_markers(arguments, false);
  Simulated simulated = simulate(
      body, model, std::move(motion), options,
      [&](const std::string& words) {
        progress.reset();
        say(arguments, "hs-simulate", words);
      },
      control, arguments[flag::torques], points ? &*points : nullptr);
  progress.reset();
  Recording& out = simulated.recording;
  Summary summary = simulated_summary(arguments, out.rows(), effects_label(model), measured);
  summary.items = {
      {"SOLVED",
       "",
       "",
       {fmt::format("{} rows, {} positions, each on its own graded mesh; mesh uncertainty {:.2f} %",
                    out.rows(), simulated.positions, 100 * simulated.mesh_uncertainty)}}};
  summary.values.push_back({"positions", static_cast<double>(simulated.positions), "1"});
  summary.values.push_back({"mesh_uncertainty", simulated.mesh_uncertainty, "1"});
  const UnseenBand band = tell_unseen(model, out, summary);
  if (points) {
    if (arguments.given(flag::marker_noise))
      add_marker_noise(simulated.markers, arguments[flag::marker_noise],
                       static_cast<std::uint64_t>(arguments[flag::seed]));
    Output markers(arguments[flag::markers_out]);
    write_markers(markers.stream(), simulated.markers);
    markers.commit();
    summary.values.push_back({"marker_rows", static_cast<double>(simulated.markers.rows()), "1"});
  }
  write_simulated(arguments, effects_label(model), out, band);
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::simulate_specification(), argc, argv, hapsim::run);
}
