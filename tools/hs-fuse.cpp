// hs-fuse: smooth forces at a high rate from a fast source and a slow one that comes late.
#include <fmt/format.h>

#include <algorithm>

#include "answer.h"
#include "base/error.h"
#include "cli/shared_flags.h"
#include "common_options.h"
#include "fusion/fused_loop.h"
#include "fusion/fusion_file.h"
#include "fusion/fusion_summary.h"
#include "fusion/fusion_words.h"
#include "hand.h"
#include "io/csv.h"
#include "model/model_edit.h"
#include "realtime/live_session.h"
#include "realtime/motion_lines.h"
#include "realtime/real_time.h"
#include "simulate/full_simulation.h"
#include "stream_options.h"

namespace hapsim {
namespace flag {
inline constexpr FileFlag slow{"--slow"}, acfm{"--acfm-model"}, parameters{"--parameters"},
    learn{"--learn"}, exact{"--exact"}, stepped{"--stepped"};
inline constexpr TimeFlag delay{"--delay"};
inline constexpr SwitchFlag live{"--live"};
inline constexpr NumberFlag rate{"--rate"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-fuse";
  spec.task = Task::kForces;
  spec.summary = "forces of a fast source put right by those of a slow one";
  spec.input = "recording with the fast forces (of an analytical model, hs-simulate)";
  spec.description = {
      "A fast source (an analytical or condensed linear model) answers every sample but errs; a "
      "slow one (finite elements, delayed measurements) is right but comes seldom and late. A "
      "Kalman filter follows what the fast source lacks: in each force component an offset, a "
      "drift, a "
      "gain and a stiffening. A slow force is put in at its own time, however late it comes; "
      "nothing is "
      "known before it is there.",
      "At rest the slow source leads; with the rate of the displacement the offset's walk falls "
      "and "
      "the slow source's noise grows, so that the fast source gains weight in fast motion. A "
      "correction is let in over a short time, so that no step is felt.",
      "--learn finds first what the slow forces teach by law: a polynomial of the displacement and "
      "its memories, kept where it foretells presses left out (of four or more), added to the fast "
      "force at the places of these presses and nowhere else. Then it finds the filter's "
      "parameters under which the slow forces, as they differ from what "
      "was predicted, are most likely, at their own pace and when they come 3 and 10 times as "
      "seldom and as late. The consistency of the filter is told as NIS, the mean of "
      "those differences squared over their variances: 1 when the filter knows its own error, with "
      "the band that it should lie in.",
      "With --exact the error and the largest step per millisecond are told, beside those of the "
      "fast source alone, of the last slow force held, and of the last two drawn on. It is of "
      "whole recordings, as --slow and --learn are.",
      "With --live SIGINT or SIGTERM ends the motion; what was answered until then, or before a "
      "bad row, is written. Its forces are for a hand: they have no effects of a force sensor. "
      "Column beyond: 1 deeper than half of the way through the body, 2 the tool is held at nine "
      "tenths of it, 3 both.",
      "With --hand the forces go through the last layer before a hand: within the limits they are "
      "what they were; where no motion comes for --hold, lines go out of their own until the force "
      "is zero, and an end after that has exit code 5. The last line is zero, whatever ends the "
      "motion."};
  spec.options = {
      {.flag = flag::slow,
       .value = "FILE",
       .help = "Slow forces: a recording of the same presses at times of its own; a column arrives "
               "[s] tells when each row is there.",
       .group = "Input"},
      {.flag = flag::delay,
       .value = "S",
       .help = "How late the rows of --slow are where they have no column arrives [s].",
       .group = "Input",
       .default_text = "0",
       .minimum = 0,
       .maximum = 100},
      {.flag = flag::stepped,
       .value = "FILE",
       .help = "Forces of the fast source in the slow one's steps (the rows of --slow through the "
               "analytical model): what steps that are long make of a body that relaxes is taken "
               "off the slow forces, as --live does.",
       .group = "Input"},
      {.flag = flag::live,
       .help = "Answers a motion line by line: --acfm-model is the fast source, finite elements of "
               "--model "
               "on --body run beside it at their own pace.",
       .group = "Live"},
      {.flag = flag::body,
       .value = "FILE",
       .help = "Live: body from hs-tetmesh; its own mesh is pressed (hs-tetmesh --contacts).",
       .group = "Live"},
      {.flag = flag::model,
       .value = "FILE",
       .help = "Live: model of the finite elements, as for hs-simulate --full.",
       .group = "Live"},
      {.flag = flag::acfm,
       .value = "FILE",
       .help = "Live: analytical model from hs-identify --acfm.",
       .group = "Live"},
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Live: radius of the flat tool [m]; otherwise the motion's metadata.",
       .group = "Live",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::rate,
       .value = "HZ",
       .help = "Live: takes the lines at this rate by the clock.",
       .group = "Live",
       .default_text = "1000",
       .minimum = 1,
       .maximum = 100000},
      {.flag = flag::parameters,
       .value = "FILE",
       .help = "The filter's parameters (CSV), as --learn writes them.",
       .group = "Learning"},
      {.flag = flag::learn,
       .value = "FILE",
       .help = "Learns the parameters from these recordings, writes them to FILE and uses them.",
       .group = "Learning",
       .writes = kTableExtensions},
      {.flag = flag::exact,
       .value = "FILE",
       .help = "Recording of the same rows with exact forces to compare with.",
       .group = "Input"}};
  spec.tables = {
      {"Output",
       {{"...", "the columns of the fast recording, its forces replaced"},
        {"sdx, sdy, sdz", "standard deviation that the filter states [N]"}}},
      {"Parameters",
       {{"axis", "x, y or z: every component has its own"},
        {"offset_walk", "of the offset at rest [N/s^0.5]"},
        {"walk_rate", "rate at which that has fallen to a tenth, its floor [m/s]"},
        {"offset_time", "in which the offset decays [s]"},
        {"drift_walk", "of the drift at rest [N/s^1.5]"},
        {"drift_time", "in which the drift decays [s]"},
        {"gain_walk", "of the gain along a way of force_scale of the fast force"},
        {"gain_spread", "standard deviation of gain and stiffening at the start"},
        {"noise", "of the slow source at rest [N]"},
        {"noise_rise", "its growth with the rate [N s/m]"},
        {"force_scale", "force at which the stiffening is one of the force [N]"},
        {"blend", "time over which a correction is let in [s]"},
        {"share0..8, age_share0..8",
         "of the corrections that are let in, by the way since the newest slow force "
         "(none yet, to 0.2 mm, 0.4 mm, ...) and by the time since (to 10 ms, 20 ms, "
         "...)"},
        {"share_known", "observations that the shares are worth, as they go on learning"},
        {"taught...", "what the slow forces teach by law, from --learn"}}}};
  for (const Option& option : hand_flags()) spec.options.push_back(option);
  spec.options.push_back(answer_option("Output"));
  spec.examples = {
      {"hs-fuse fast.csv --slow fe.csv --delay 0.05 --learn filter.csv -o fused.csv",
       "Learns the filter and fuses."},
      {"hs-fuse fast.csv --slow fe.csv --delay 0.05 --parameters filter.csv --exact fine.csv -o "
       "fused.csv",
       "Another motion with it, compared with the exact forces."},
      {"hs-fuse --live motion.csv --body body.ply --model finite.csv --acfm-model acfm.csv "
       "--parameters "
       "filter.csv",
       "Finite elements beside a loop at 1 kHz."}};
  spec.see_also = {"hs-simulate(1)", "hs-identify(1)"};
  return spec;
}

FusionParameters given_parameters(const Arguments& arguments) {
  if (!arguments.given(flag::parameters)) return {};
  Input file(arguments[flag::parameters]);
  return read_fusion(file);
}

class FinitePress : public SlowPress {
 public:
  FinitePress(const TetMesh& body, const Model& model, const Vec3& contact, double radius)
      : press_(body, model, contact, radius, own_mesh()) {}
  Vec3 step(const Vec3& u, double dt) override { return press_.step(u, dt); }

 private:
  static FullOptions own_mesh() {
    FullOptions options;
    options.own_mesh = true;
    return options;
  }
  FullPress press_;
};

int run_live_fusion(const Arguments& arguments) {
  for (const AnyFlag& flag : AnyFlags{flag::body, flag::model, flag::acfm})
    if (!arguments.given(flag)) fail_usage("--live needs " + flag, "give it");
  for (const AnyFlag& flag :
       AnyFlags{flag::slow, flag::learn, flag::exact, flag::delay, flag::stepped})
    if (arguments.given(flag))
      fail_usage(flag + " is of whole recordings", "leave it out, or --live");
  const std::optional<SafetyLimits> hand = hand_limits(arguments);
  Input model_input(arguments[flag::model]), acfm_input(arguments[flag::acfm]);
  const Model model = read_model(model_input);
  const Acfm acfm = read_acfm(acfm_input);
  const TetMesh body = load_body(arguments);
  const SignedDistance surface(boundary_surface(body), "body");
  Input input(arguments.input());
  MotionLines motion(input);
  const double radius = stream_radius(arguments, motion.metadata(), input.name());
  motion.within(body.nodes);
  AcfmLoop fast(acfm), coarse(acfm);
  FusedLoop loop(
      fast,
      [&](const Vec3& contact) {
        return std::make_unique<FinitePress>(body, model, contact, radius);
      },
      given_parameters(arguments), &surface, {}, &coarse);
  LiveOptions live;
  live.rate = arguments[flag::rate];
  Metadata metadata = motion.metadata();
  metadata.set("simulated", "acfm, fused with " + effects_label(model));
  Output output(arguments.output());
  CsvWriter(output.stream(), metadata,
            hand ? hand_columns(motion.force_columns()) : motion.force_columns());
  output.stream().flush();
  LiveReport report;
  HandReport felt;
  say(arguments, "hs-fuse", enter_real_time());  // this thread alone; the solver has begun before
  answer_stream(
      arguments, "hs-fuse", input,
      [&] {
        answer_hand<HandSource>(
            motion, input, hand, output.stream(), felt,
            [&](MotionSource& source) { run_live(source, output.stream(), loop, live, report); });
      },
      [&] {
        leave_real_time();
        loop.stop();
        output.commit();
        say(arguments, "hs-fuse",
            report.latency.summary() + fmt::format("; {} later than a period", report.misses));
        tell_hand(arguments, "hs-fuse", felt);
        for (const std::string& words : report.beyond_words()) say(arguments, "hs-fuse", words);
        say(arguments, "hs-fuse", "finite elements: " + loop.slow_steps().summary());
        say(arguments, "hs-fuse", fusion_words(loop.report()));
      });
  if (!loop.failure().empty())
    fail_numerics("", "the finite elements stopped: " + loop.failure(),
                  "the rest is the analytical model's alone");
  require_motion(input, felt);
  return 0;
}

int run(const Arguments& arguments) {
  if (arguments[flag::live]) return run_live_fusion(arguments);
  for (const AnyFlag& flag :
       AnyFlags{flag::body, flag::model, flag::acfm, flag::tool_radius, flag::rate, flag::hand})
    if (arguments.given(flag))
      fail_usage(flag + " is of the live mode", "add --live, or leave it out");
  hand_limits(arguments);
  if (!arguments.given(flag::slow))
    fail_usage("--slow is required", "give the slow forces, or --live");
  if (arguments.given(flag::learn) && arguments.given(flag::parameters))
    fail_usage("--learn finds what --parameters gives", "leave one of them out");
  Input input(arguments.input());
  Recording fast = read_recording(input);
  Input slow_input(arguments[flag::slow]);
  const Recording slow = read_recording(slow_input);
  std::optional<Recording> stepped;
  if (arguments.given(flag::stepped)) {
    Input stepped_input(arguments[flag::stepped]);
    stepped = read_recording(stepped_input);
  }
  const SlowSource source{&slow, arguments[flag::delay], stepped ? &*stepped : nullptr};
  FusionParameters parameters = given_parameters(arguments);
  if (arguments.given(flag::learn)) {
    const LearnedFusion learned = learn_fusion(fast, source, parameters);
    parameters = learned.parameters;
    if (!learned.converged)
      fail_numerics(slow.name,
                    fmt::format("the parameters did not settle in {} runs", learned.runs),
                    "give more of the motion that is to be fused");
    Output file(arguments[flag::learn]);
    write_fusion(file.stream(), parameters);
    file.commit();
    say(arguments, "hs-fuse", fmt::format("parameters learned in {} runs", learned.runs));
  }
  const FusedForces fused = fuse(fast, source, parameters);
  std::optional<Recording> exact;
  if (arguments.given(flag::exact)) {
    Input exact_input(arguments[flag::exact]);
    exact = read_recording(exact_input);
  }
  const Summary summary = fusion_summary(fast, fused, exact ? &*exact : nullptr);
  fast.f = fused.force;
  for (int k = 0; k < 3; ++k) {
    fast.extra_header.push_back(fmt::format("sd{}", "xyz"[k]));
    fast.extra.emplace_back();
    for (const Vec3& sd : fused.deviation) fast.extra.back().push_back(format_number(sd[k]));
  }
  fast.metadata.set("simulated",
                    fast.metadata.find("simulated").value_or("fast") + ", fused with " + slow.name);
  Output output(result_file(arguments));
  write_recording(output.stream(), fast);
  output.commit();
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
