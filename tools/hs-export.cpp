// hs-export: a model, its body and a press as the input of other solvers.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "answer.h"
#include "base/error.h"
#include "cli/shared_flags.h"
#include "common_options.h"
#include "contact/contact_cache.h"
#include "exchange/match.h"
#include "exchange/scene.h"
#include "formats/field_vtu.h"
#include "formats/mesh_file.h"
#include "io/extension.h"

namespace hapsim {
namespace flag {
inline constexpr ChoiceFlag format{"--format"};
inline constexpr FileFlag data{"--data"};
inline constexpr IntegerFlag press{"--press"}, steps{"--steps"};
inline constexpr SwitchFlag bare{"--bare"}, match{"--match"};
}  // namespace flag

namespace {

// Of --format.
const std::map<std::string, std::string> kExtension{{"calculix", "inp"}, {"febio", "feb"},
                                                    {"sofa", "scn"},     {"mujoco", "xml"},
                                                    {"vtu", "vtu"},      {"gmsh", "msh"}};

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-export";
  spec.task = Task::kForces;
  spec.summary = "a model, its body and a press as input of CalculiX, FEBio, SOFA or MuJoCo";
  spec.input = "model CSV from hs-identify";
  spec.description = {
      "Writes the body with the model's materials, its support, and a flat bonded tool that makes "
      "one "
      "press of the recording, so that another program solves what hapsim solves: elastic bodies, "
      "regions, neo-Hookean finite strain (hyperelastic with s = 0), and for FEBio relaxation. An "
      "effect that the other program cannot have is refused by its name.",
      "The forces of a linear body of first-order tetrahedra are those of hs-simulate --own-mesh; "
      "the finer contact meshes, from which hs-identify works, are not part of the body. With "
      "second "
      "order and with finite strain hapsim averages the change of volume over each tetrahedron, or "
      "over neighbours, against locking; CalculiX does not, and is stiffer: on a second-order "
      "block "
      "four elements wide by 2 % at nu = 0.2, 8 % at 0.45, 14 % at 0.49 and 24 % at 0.499.",
      "A body's own mesh is mostly too coarse under the tool, and the force wrong by tens of per "
      "cent. With --match the deck has instead the mesh that hapsim solves for this press, graded "
      "to the tool's rim, of straight elements (second order; first for SOFA), and all moduli "
      "times one factor for what these elements are stiffer by without hapsim's averaging. The "
      "factor is learned at other places of the recording, each on its own mesh; the press itself "
      "and every second place are held out, where the recording has others. Deck and summary say "
      "how far the force is from "
      "hapsim's there, by elements integrated as the program does it: at rest and small strain, "
      "along the deepest displacement of each press.",
      "MuJoCo has no such bodies: of an elastic one it gets the tool on three springs, which are "
      "the "
      "body under it at that press, bonded and at small strain, from hapsim's own mesh; forces of "
      "whole bodies it gets by a callback (share/examples/mujoco). Programs that take an FMU get "
      "those "
      "forces by share/examples/fmu.",
      "vtu and gmsh hold the mesh alone, the model's regions or else its own, and for vtu the "
      "moduli. "
      "Every tool that takes --body, and hs-tetmesh, reads any of these back but MuJoCo's: nodes, "
      "tetrahedra, regions and what is fixed."};
  spec.options = {
      {.flag = flag::format,
       .value = "PROGRAM",
       .help =
           "calculix (.inp, also Abaqus), febio (.feb, febio_spec 4.0), sofa (.scn, from 23.12), "
           "mujoco (.xml, from 2.2), "
           "vtu (ParaView), gmsh (2.2).",
       .group = "Output",
       .choices = {"calculix", "febio", "sofa", "mujoco", "vtu", "gmsh"},
       .required = true},
      {.flag = flag::body,
       .value = "FILE",
       .help = "Body from hs-tetmesh, or another mesh of tetrahedra with fixed nodes: " +
               names_to_read(Content::kTetrahedra) + ".",
       .group = "Input",
       .required = true},
      {.flag = flag::data,
       .value = "FILE",
       .help = "Recording or motion whose press is exported; without it, body and materials alone.",
       .group = "Input"},
      calibration_option("Input"),
      {.flag = flag::press,
       .value = "ID",
       .help = "Which press of it; otherwise the first.",
       .group = "Input"},
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Radius of the flat tool [m]; otherwise the recording's metadata tool_radius.",
       .group = "Input",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::steps,
       .value = "N",
       .help = "Rows of the press that are kept, evenly, the deepest among them.",
       .group = "Output",
       .default_text = "20",
       .minimum = 1,
       .maximum = 100000},
      {.flag = flag::match,
       .help = "Another mesh and moduli, with which the program's force is hapsim's.",
       .group = "Output"},
      {.flag = flag::bare,
       .help = "Leaves out effects on the motion and of the sensor instead of refusing them.",
       .group = "Output"},
      {.flag = flag::threads,
       .value = "N",
       .help = "Places compared side by side; 0: as many as the machine has cores.",
       .group = "General",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1024},
      {.flag = flag::cache,
       .value = "DIR",
       .help = "Where prepared stiffnesses are kept by content ('none': nowhere); otherwise the "
               "user's cache folder.",
       .group = "General"}};
  spec.options.push_back(answer_option("General"));
  spec.writes.clear();
  for (const auto& [format, extension] : kExtension) spec.writes.push_back(extension);
  spec.examples = {
      {"hs-export model.csv --body body.ply --data data.csv --format calculix -o press.inp && ccx "
       "press",
       "The force of each step stands in press.dat, as that of the tool on the body."},
      {"hs-export model.csv --body body.ply --data data.csv --press 3 --match --format calculix -o "
       "press.inp",
       "Press 3 with a force that is hapsim's; how nearly stands in the deck."},
      {"hs-export model.csv --body body.ply --data data.csv --press 3 --format febio -o press.feb",
       "Press 3, with its relaxation."},
      {"hs-export model.csv --body body.ply --format vtu -o body.vtu",
       "Regions and moduli for ParaView."}};
  spec.see_also = {"hs-simulate(1)", "hs-tetmesh(1)", "hs-effects(7)"};
  return spec;
}

Press asked_press(const Arguments& arguments, const Recording& recording) {
  const std::vector<Press> presses = recording.presses();
  if (!arguments.given(flag::press)) return presses.front();
  for (const Press& press : presses)
    if (press.id == arguments[flag::press]) return press;
  fail_usage("--press: the recording has no press " + arguments.text(flag::press),
             fmt::format("its presses are {} to {}", presses.front().id, presses.back().id));
}

void write_vtu(std::ostream& out, const Scene& scene) {
  VtuArray modulus{"E", 1, {}}, nu{"nu", 1, {}};
  for (const int region : scene.mesh.region) {
    modulus.values.push_back(scene.modulus_of(region));
    nu.values.push_back(scene.nu);
  }
  write_field_vtu(out, scene.mesh, {}, {modulus, nu});
}

PrepareOptions prepare_options(const Arguments& arguments) {
  PrepareOptions prepare{static_cast<int>(arguments[flag::threads]), default_cache_directory()};
  if (arguments.given(flag::cache))
    prepare.cache = arguments[flag::cache] == std::string("none") ? "" : arguments[flag::cache];
  return prepare;
}

// What the deck's force will be, in the deck and in the summary; with --match, made right first.
void tell_error(const Arguments& arguments, const TetMesh& body, const Model& model,
                const Recording& recording, const Press& press, Scene& scene, Summary& summary) {
  const PrepareOptions prepare = prepare_options(arguments);
  if (arguments[flag::match]) {
    const bool sofa = arguments[flag::format] == std::string("sofa");
    const Match match = match_scene(scene, body, model, recording, press,
                                    {.order = sofa ? 1 : 2, .prepare = prepare});
    summary.notes.push_back(match_words(match));
    summary.values.push_back({"force_error", match.presses[0].error, "1"});
    if (match.learned() < match.presses.size())
      summary.values.push_back({"largest_held_out_error", match.largest_unseen(), "1"});
    summary.values.push_back({"force_error_without", match.before, "1"});
    summary.values.push_back({"modulus_factor", match.factor, "1"});
    scene.remarks.push_back("matched to hapsim: " + summary.notes.back());
    return;
  }
  try {
    const double error = deck_error(
        deck_stiffness(scene), graded_presses(body, model, recording, {press}, prepare).front());
    summary.notes.push_back(deck_words(scene, error));
    if (summary.notes.back().starts_with("warning")) summary.mark = Summary::Mark::kOpen;
    summary.values.push_back({"force_error", error, "1"});
  } catch (const Error& error) {  // the deck is right all the same
    summary.mark = Summary::Mark::kOpen;
    summary.notes.push_back(std::string("what its mesh does to the force is not known: ") +
                            error.what());
  }
  scene.remarks.push_back(summary.notes.back());
}

int run(const Arguments& arguments) {
  const std::string format = arguments[flag::format], end = extension_of(arguments.output());
  const bool promised = std::any_of(kExtension.begin(), kExtension.end(),
                                    [&](const auto& known) { return known.second == end; });
  if (promised && end != kExtension.at(format))
    fail_usage(fmt::format("--output ends in .{}, and --format is {}", end, format),
               "end it in ." + kExtension.at(format));
  for (const AnyFlag& flag : AnyFlags{flag::press, flag::tool_radius, flag::calibration})
    if (arguments.given(flag) && !arguments.given(flag::data))
      fail_usage(flag + " is of a press, and there is none", "add --data FILE");
  Input model_input(arguments.input());
  const Model model = load_model(arguments, "hs-export", model_input);
  const std::string input_name = model_input.name();
  const TetMesh body = load_body(arguments);
  say_idle(arguments, "hs-export", model, body);
  const bool solved = format == "calculix" || format == "febio" || format == "sofa";
  if (arguments[flag::match] && !(solved && arguments.given(flag::data)))
    fail_usage("--match is of a press that a program solves",
               solved ? "add --data FILE" : "export to calculix, febio or sofa");
  const bool springs = format == "mujoco";
  if (springs && !arguments.given(flag::data))
    fail_usage("springs for mujoco are of a press", "add --data FILE");
  Recording recording;
  Press press;
  if (arguments.given(flag::data)) {
    recording = load_recording(arguments, arguments[flag::data], false);
    press = asked_press(arguments, recording);
  }
  Scene scene = make_scene(
      body, model, recording, press.rows,
      {.steps = static_cast<std::size_t>(arguments[flag::steps]), .bare = arguments[flag::bare]});
  scene.body_name = arguments[flag::body];
  const bool pressed = solved && !scene.tool.empty();
  Summary summary;
  if (pressed) tell_error(arguments, body, model, recording, press, scene, summary);
  GradedPress graded;
  if (springs) {
    graded = graded_presses(body, model, recording, {press}, prepare_options(arguments)).front();
    scene.remarks.emplace_back(
        "springs of hapsim: at this place and small strain the force is its own");
  }
  Output output(result_file(arguments));
  if (format == "calculix") write_calculix(output.stream(), scene);
  if (format == "febio") write_febio(output.stream(), scene);
  if (format == "sofa") write_sofa(output.stream(), scene);
  if (springs) write_mujoco(output.stream(), scene, graded, recording.tool_radius());
  if (format == "vtu") write_vtu(output.stream(), scene);
  if (format == "gmsh") write_mesh_gmsh(output.stream(), scene.mesh);
  output.commit();
  if (solved && !arguments[flag::match] && (scene.mesh.order == 2 || scene.finite))
    summary.notes.emplace_back(
        "hapsim averages the change of volume here and is less stiff; see hs-export(1)");
  summary.verdict = fmt::format("{} as input of {}", input_name, format);
  summary.size =
      fmt::format("{} tetrahedra of order {}{}", scene.mesh.tets.size(), scene.mesh.order,
                  pressed || springs ? fmt::format(", {} steps", scene.t.size()) : "");
  summary.values.insert(summary.values.begin(),
                        {{"tetrahedra", static_cast<double>(scene.mesh.tets.size()), "1"},
                         {"order", static_cast<double>(scene.mesh.order), "1"},
                         {"steps", static_cast<double>(scene.t.size()), "1"}});
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
