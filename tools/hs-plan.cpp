// hs-plan: which presses to record next, in a closed loop, until enough is known.
#include <numbers>

#include "base/error.h"
#include "cli/shared_flags.h"
#include "cli/tell.h"
#include "common_options.h"
#include "explore/explore_summary.h"

namespace hapsim {
namespace flag {
inline constexpr TextFlag goal{"--goal"};
inline constexpr IntegerFlag presses{"--presses"}, most_presses{"--most-presses"}, seed{"--seed"};
inline constexpr LengthFlag depth{"--depth"};
inline constexpr NumberFlag steepest{"--steepest"};
inline constexpr SwitchFlag more{"--more"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-plan";
  spec.task = Task::kRecording;
  spec.summary = "say which presses to record next, until enough is known";
  spec.input = "recording CSV of all presses so far; without rows (/dev/null) of none";
  const std::string least = std::to_string(kLeastPresses);
  spec.description = {
      "One round of a closed loop: reads what was measured so far, and answers with the motion "
      "that "
      "is worth most to record next, or with none when the goals (--goal) are reached. Its "
      "presses "
      "have numbers and times that go on after the recording's, so its rows, with the forces that "
      "were measured, are simply added to it.",
      "Fewer than " + least +
          " presses settle nothing. So the first ones are spread over the body, each along another "
          "motion: deep and held, sideways along two directions, slow. The places are those that "
          "lower most the variance of a Gaussian process over the part of the surface that looks "
          "up "
          "(--steepest) and goes on around the tool; later those count more where the stiffness "
          "stands out.",
      "From then on the model is diagnosed as hs-diagnose(1) does. Where a motion is lacking "
      "without "
      "which some effect cannot show (a push sideways, a way out, a hold of a second, a second "
      "pace), "
      "that comes next. Where effects do equally well, or none passes its gates and several are "
      "possible, the presses are those that tell them apart, as its --plan says; a plan that "
      "promises "
      "less than three standard deviations of the noise is not asked for, but places that were not "
      "pressed yet. A verdict is settled when one set of effects explains all or nothing is "
      "missing, "
      "no such motion is lacking, and presses lie at six places a tool's radius apart or more. "
      "What "
      "the recording cannot test whatever is pressed (a column of times or temperatures is "
      "missing) "
      "is said to be outside it, and how far apart the places are: what lies between or deeper "
      "than "
      "presses feel is not known. Once the verdict is settled, the parameter that is farthest from "
      "its goal is determined, at new places: at one that was pressed the meshes err as before, "
      "and "
      "another press there tells little. A parameter is not known while it, or Poisson's ratio "
      "beside "
      "a modulus, is at its bound; a modulus never better than what mesh and shape allow "
      "(--floor), "
      "which is said at once.",
      "For the forces at places that nobody has pressed (unseen) those that were are left out, one "
      "at a time or in twenty parts, and foretold by a model made without them, its regions or "
      "curves too. The error is the root mean square over the part of the surface that can be "
      "pressed, each place standing for what lies nearest to it. It is rather too large than too "
      "small, for a place that was left out lay farther from the others than any place does now, "
      "but it knows of mesh and shape no more than the pressed places show. The next presses lie "
      "where the places around were foretold worst, as between two regions. A boundary that leaves "
      "more than noise is moved with the moduli beside it, as hs-identify --refine-boundary does, "
      "which is to be given with --effects auto in the end.",
      "For a lump the presses of all places are looked at as by hs-identify --lumps. Where one is "
      "seen, the next presses are those after which its centre is known best, as a small lump in a "
      "half-space would have it; otherwise they lie where the stiffness stands out and where least "
      "is known.",
      "New places lie a tool's radius or more from those that were pressed. With none left no more "
      "presses are asked for: the goals cannot be reached with this tool on this body.",
      "No press goes deeper than --depth, nor, where the body is thin, than half of the way "
      "through "
      "it; without --depth than a third.",
      "A loop of a shell: --more ends it, and so does anything that fails. A robot prints the "
      "recording's comments and header once, with the first motion, and rows alone after that: "
      "they are added to one table."};
  spec.options = experiment_flags();
  const std::vector<Option> own{
      {.flag = flag::model,
       .value = "FILE",
       .help = "Model to go out from; otherwise an elastic one is fitted.",
       .group = "Input"},
      {.flag = flag::goal,
       .value = "GOALS",
       .help =
           "What shall be known: verdict (nothing is missing, or what is missing explains all "
           "and has no rival); PARAMETER=SHARE, its relative standard error with all that is "
           "missing, as E=0.02 or viscoelastic.E1=10%, which asks for the verdict too; "
           "unseen=NUMBER, that the forces at places that nobody has pressed are foretold to so "
           "many "
           "times the noise, or unseen=SHARE, as 5%, of the force, which asks for the verdict too; "
           "lump=LENGTH, that one is seen and its centre lies within so much to each side, with "
           "95 %.",
       .group = "Plan",
       .default_text = "verdict",
       .repeatable = true},
      {.flag = flag::presses,
       .value = "N",
       .help = "Number of presses of the next motion.",
       .group = "Plan",
       .default_text = "1",
       .minimum = 1,
       .maximum = 100},
      {.flag = flag::most_presses,
       .value = "N",
       .help =
           "With so many presses in the recording no more are asked for, whatever is known, nor a "
           "motion with more than are left.",
       .group = "Plan",
       .default_text = "60",
       .minimum = 1,
       .maximum = 100000},
      {.flag = flag::depth,
       .value = "M",
       .help = "The deepest that a press goes [m]; most go two thirds of it. Otherwise that no "
               "press is "
               "deeper than those so far went into the surface; of the first presses 1.125 radii "
               "of the "
               "tool, 0.15 of the body's least extent at most.",
       .group = "Plan",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::steepest,
       .value = "DEG",
       .help = "Places whose normals are farther from +z are not pressed [deg].",
       .group = "Plan",
       .default_text = "45",
       .minimum = 0.1,
       .maximum = 180},
      {.flag = flag::more,
       .help = "Exit code 1 when no more presses are asked for, so that `while hs-plan --more ...` "
               "ends.",
       .group = "Output"},
      {.flag = flag::json,
       .value = "FILE",
       .help = "Writes whether the goals are reached (reached), what each is at, and the next "
               "presses with their reason as JSON.",
       .group = "Output",
       .writes = {"json"}},
      {.flag = flag::seed,
       .value = "N",
       .help = "Seed of the diagnosis' sign flips.",
       .group = "General",
       .default_text = "1",
       .minimum = 0}};
  spec.options.insert(spec.options.end(), own.begin(), own.end());
  spec.tables = {{"Motion (output)",
                  {{"press, t, x, y, z, ux, uy, uz, contact",
                    "as in hs-identify(1), without forces; with a piece of air before and after "
                    "each press; no "
                    "rows when no more presses are asked for"}}}};
  spec.examples = {{"hs-plan /dev/null --body body.ply --tool-radius 4mm --presses 6 -o first.csv",
                    "The first presses of a body."},
                   {"hs-plan data.csv --body body.ply --goal E=2% --json plan.json -o next.csv",
                    "What to record next, and why."},
                   {"touch data.csv; while hs-plan data.csv --body body.ply --tool-radius 4mm "
                    "--more -o m.csv && "
                    "robot m.csv >>data.csv; do :; done",
                    "A closed loop: `robot` executes a motion and prints its rows with forces, the "
                    "first time with a header."}};
  spec.see_also = {"hs-diagnose(1)", "hs-identify(1)", "hs-effects(7)"};
  return spec;
}

// The lines of a table that are no comments, two of them at most: a header and perhaps a row.
std::vector<std::string> first_lines(const std::string& bytes) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < bytes.size() && lines.size() < 2;) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::size_t first = bytes.find_first_not_of(" \t\r", begin);
    if (first < end && bytes[first] != '#') lines.push_back(bytes.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

// Error(kBadInput) where a line is no header of a recording: it is read with a row of zeros.
void require_header(const std::string& header, const std::string& name) {
  std::string row;
  for (const char c : header)
    if (c == ',' || c == ';' || c == '\t')
      row += c;
    else if (row.empty() || row.back() != '0')
      row += '0';
  Input input = Input::from_bytes(header + "\n" + row + "\n", name);
  read_recording(input);
}

// All presses so far; before the first, what the comments say of the tool.
Recording load_so_far(const Arguments& arguments) {
  Input given(arguments.input());
  const std::string bytes = given.read_all();
  Input input = Input::from_bytes(bytes, given.name());
  const std::vector<std::string> lines = first_lines(bytes);
  if (lines.size() > 1)
    return as_asked(arguments, read_measured(arguments, input), true,
                    [&](const std::string& words) { say(arguments, words); });
  if (!lines.empty()) require_header(lines.front(), given.name());
  Recording none;
  none.name = given.name();
  for (std::string line; input.read_line(line);)
    if (!line.empty() && line[0] == '#') none.metadata.add_line(line.substr(1));
  if (arguments.given(flag::tool_radius))
    none.metadata.set("tool_radius", arguments.text(flag::tool_radius));
  none.tool_radius();  // fails now when it is missing
  return none;
}

int run(const Arguments& arguments) {
  ExploreOptions options;
  options.goals = parse_goals(arguments.list(flag::goal), flag::goal.name);
  options.presses = static_cast<std::size_t>(arguments[flag::presses]);
  options.most_presses = static_cast<std::size_t>(arguments[flag::most_presses]);
  if (arguments.given(flag::depth)) options.depth = arguments[flag::depth];
  options.steepest = arguments[flag::steepest] * std::numbers::pi / 180;
  const Model model = arguments.given(flag::model) ? load_model(arguments, "hs-plan") : Model{};
  const Recording recording = load_so_far(arguments);
  std::vector<Vec3> window;
  const TetMesh body = load_body(arguments, &window);
  say_idle(arguments, "hs-plan", model, body);
  options.experiment = preparation_options(arguments);
  options.diagnose.seed = static_cast<std::uint64_t>(arguments[flag::seed]);
  auto progress = std::make_unique<Progress>(arguments, "", 0);
  options.diagnose.progress = [&](const std::string& what, std::size_t k, std::size_t n) {
    progress->show(what, k, n);
  };
  const Exploration next = explore(body, window, model, recording, options);
  progress.reset();

  if (result_is_wanted(arguments)) {
    Output output(arguments.output());
    write_recording(output.stream(), next.plan.motion);
    output.commit();
  }
  if (arguments.given(flag::json)) {
    Output json(arguments[flag::json]);
    json.write(explore_json(next));
    json.commit();
  }
  say_summary(arguments, explore_summary(next, recording.name,
                                         arguments.output() == "-" ? "" : arguments.output()));
  return static_cast<int>(arguments[flag::more] && next.done() ? ExitCode::kCheckFailed
                                                               : ExitCode::kDone);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
