// hs-simulate: the forces of a model along a motion.
#include <fmt/format.h>

#include "base/random.h"
#include "common_options.h"
#include "io/csv.h"
#include "model/edit.h"
#include "model/forces.h"

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
      "hs-identify alike."};
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
  spec.examples = {
      {"hs-simulate data.csv --body body.ply --model m0.csv -o forces.csv", "Forces of a model."},
      {"hs-simulate data.csv --body body.ply --model m0.csv | hs-compare data.csv --simulated -",
       "Where the model fails."}};
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-diagnose(1)"};
  return spec;
}

int run(const Arguments& arguments) {
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
