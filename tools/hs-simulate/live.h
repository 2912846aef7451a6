// hs-simulate --live: motion in, forces out at once.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "acfm/acfm_loop.h"
#include "base/error.h"
#include "common_options.h"
#include "hand.h"
#include "hs-simulate/flags.h"
#include "model/model_edit.h"
#include "prepared_options.h"
#include "realtime/force_loop.h"
#include "realtime/live_session.h"
#include "realtime/live_tools.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
#include "realtime/real_time.h"
#include "realtime/tool_lines.h"
#include "realtime/tool_records.h"
#include "simulate/simulate.h"
#include "stream_options.h"

namespace hapsim {

// The positions of --contacts, to be solved finely for any material. `progress` must outlive it.
inline std::optional<Experiment> fine_contacts(const Arguments& arguments, const TetMesh& body,
                                               const Model& model,
                                               std::shared_ptr<Progress>& progress) {
  if (!arguments.given(flag::contacts)) return std::nullopt;
  ExperimentOptions options = experiment_options(arguments, progress);
  set_poisson_range(model, options);
  return make_experiment(body, load_pressed(arguments, arguments[flag::contacts], false, model),
                         options);
}

// Where the motion comes from: of one tool that keeps its orientation `source`, else `several`.
struct LiveInput {
  explicit LiveInput(const Arguments& arguments) : input(arguments.input()) {
    if (arguments.given(flag::add_noise))
      fail_usage("--add-noise is of the batch mode", "leave it out, or --live");
    hand = hand_limits(arguments);
    binary = arguments.given(flag::binary);
    if (binary && arguments.given(flag::tools))
      fail_usage("--tools is of lines", "records say themselves of how many tools they are");
    if (binary) {
      const std::string kind = arguments[flag::binary];
      if (arguments.given(flag::uncertainty) && kind != "extended")
        fail_usage("records of " + kind + " have no place for --uncertainty",
                   "leave it out, or take --binary extended, which always has it");
      if (kind == "extended") {
        auto records = std::make_unique<ToolRecords>(input);
        header = records->header();
        several = std::move(records);
      } else {
        source = std::make_unique<MotionRecords>(
            input, kind == "tip" ? MotionRecords::Kind::kTip : MotionRecords::Kind::kPress);
      }
      return;
    }
    CsvReader csv(input);
    if (ToolLines::serves(csv.header())) {
      const std::size_t tools =
          arguments.given(flag::tools) ? static_cast<std::size_t>(arguments[flag::tools]) : 0;
      auto lines = std::make_unique<ToolLines>(std::move(csv), input.name(), tools);
      if (hand) lines->tell_hand();
      metadata = lines->metadata();
      if (arguments.given(flag::uncertainty)) lines->tell_uncertainty();
      columns = lines->columns();
      several = std::move(lines);
      return;
    }
    if (arguments.given(flag::tools) && arguments[flag::tools] > 1)
      fail_input(input.name(), "there are several tools, and no column tool_id",
                 "say of each line which tool it is of");
    auto lines = std::make_unique<MotionLines>(std::move(csv), input.name(), false);
    if (arguments.given(flag::uncertainty)) lines->tell_uncertainty();
    metadata = lines->metadata();
    columns = hand ? hand_columns(lines->force_columns()) : lines->force_columns();
    source = std::move(lines);
  }
  bool has_contact_point() const {
    return source ? source->has_contact_point() : several->has_contact_point();
  }
  void within(const std::vector<Vec3>& nodes) {
    source ? source->within(nodes) : several->within(nodes);
  }
  bool remembers() const { return metadata.find("recovery").value_or("") == "none"; }
  bool heals() const { return metadata.find("recovery").value_or("") == "full"; }
  ToolLoopOptions loop_options() const {
    ToolLoopOptions options;
    options.relaxed = has_contact_point() || !remembers();
    return options;
  }

  Input input;
  bool binary = false;
  std::unique_ptr<MotionSource> source;
  std::unique_ptr<ToolSource> several;
  Metadata metadata;                 // binary motion has none
  std::vector<std::string> columns;  // of the answers; records have none
  std::string header;                // of the answers: extended records have one
  std::optional<SafetyLimits> hand;  // that the forces are for
  HandReport felt;
};

// Answers everything until the motion ends: `run` reads, answers and writes.
template <class Run>
int answer_by(const Arguments& arguments, LiveInput& in, const std::string& label, const Run& run) {
  LiveOptions live;
  if (arguments.has(flag::rate)) live.rate = arguments[flag::rate];
  live.remembers = in.remembers();
  if (live.rate > 0) {
    widen_pipes();
    say(arguments, "hs-simulate", enter_real_time());
  }
  mark_simulated(in.metadata, label);
  Output output(arguments.output());
  if (!in.binary) CsvWriter(output.stream(), in.metadata, in.columns);
  output.stream() << in.header;
  output.stream().flush();
  LiveReport report;
  answer_stream(
      arguments, "hs-simulate", in.input, [&] { run(output.stream(), live, report); },
      [&] {
        output.commit();
        std::string text = report.latency.summary();
        if (live.rate > 0)
          text +=
              fmt::format("; {} of {} later than a period", report.misses, report.latency.count());
        say(arguments, "hs-simulate", text);
        tell_hand(arguments, "hs-simulate", in.felt);
        for (const std::string& words : report.beyond_words()) say(arguments, "hs-simulate", words);
      });
  require_motion(in.input, in.felt);
  return 0;
}

inline int answer(const Arguments& arguments, LiveInput& in, const std::string& label,
                  ToolLoop& loop) {
  return answer_by(arguments, in, label,
                   [&](std::ostream& out, const LiveOptions& live, LiveReport& report) {
                     answer_hand<HandSource>(
                         *in.source, in.input, in.hand, out, in.felt,
                         [&](MotionSource& motion) { run_live(motion, out, loop, live, report); });
                   });
}

// What several tools do under each other; none of one tool.
inline std::optional<ToolCoupling> couple_tools(const Arguments& arguments, const LiveInput& in,
                                                const TetMesh& mesh, const Model& model,
                                                const PreparedBody& body) {
  std::optional<ToolCoupling> coupling;
  if (!in.several || in.several->tools() < 2) return coupling;
  const std::int64_t start = monotonic_ns();
  Progress progress(arguments, "what one tool does under another", 0);
  coupling.emplace(mesh, model, body.tool_radius());
  clear_progress_line();
  say(arguments, "hs-simulate",
      fmt::format("what one tool does under another: {} corners of the surface condensed in "
                  "{:.2g} s, in {} order",
                  coupling->corners(), 1e-9 * static_cast<double>(monotonic_ns() - start),
                  coupling->second_order() ? "second" : "first"));
  return coupling;
}

// Several tools, or one that turns.
inline int answer_several(const Arguments& arguments, LiveInput& in, const Model& model,
                          const PreparedBody& body, const std::optional<ToolCoupling>& coupling,
                          const ToolLoopOptions& options) {
  SeveralTools tools(body, coupling ? &*coupling : nullptr, in.several->tools(), options);
  return answer_by(arguments, in, effects_label(model),
                   [&](std::ostream& out, const LiveOptions& live, LiveReport& report) {
                     answer_hand<HandTools>(*in.several, in.input, in.hand, out, in.felt,
                                            [&](ToolSource& motion) {
                                              run_live_tools(motion, out, tools, live, report);
                                            });
                   });
}

// How well what was pressed beforehand foretells what was not.
inline void tell_large_strain(const Arguments& arguments, const PreparedBody& body) {
  const LargeStrain* strain = body.large_strain();
  if (strain == nullptr) return;
  std::string words =
      fmt::format("large strain: {} places pressed, forces at places left out {:.1f} % off",
                  strain->samples(), 100 * strain->left_out_error());
  if (strain->left_out_error() > arguments[flag::accuracy])
    words += fmt::format(", not the {:g} % of --accuracy", 100 * arguments[flag::accuracy]);
  if (const std::optional<StrainSlip>& slip = strain->slip())
    words += fmt::format(
        "; a tool that slips was pressed to {:.3g} of its radius (from {:.3g} on with an "
        "uncertainty of its own), deeper rows are flagged 32",
        slip->deepest(), slip->near.deepest);
  for (const EffectInstance& i : body.effects())
    if (touches_otherwise(i, strain->slip().has_value()))
      words += fmt::format(
          "; they were pressed by a flat tool that holds, so with {} every row is flagged 32",
          i.effect->card().name);
  say(arguments, "hs-simulate", words);
}

inline int run_live_mode(const Arguments& arguments, const Model& model) {
  const TetMesh mesh = load_body(arguments);
  say_idle(arguments, "hs-simulate", model, mesh);
  LiveInput in(arguments);
  std::shared_ptr<Progress> progress;
  const std::optional<Experiment> fine = fine_contacts(arguments, mesh, model, progress);
  progress.reset();
  PreparedBodyOptions options = prepared_options(
      arguments, contact_radius(model, stream_radius(arguments, in.metadata, arguments.input())),
      progress);
  const ExperimentOptions places = experiment_options(arguments, progress);
  options.threads = places.threads;
  options.cache = places.cache;
  options.rim_edge = places.rim_edge;
  if (fine)
    options.contacts = [&](const MaterialSpec& material) {
      return known_contacts(fine->places, material);
    };
  options.heals = in.heals();
  options.large_strain = arguments.given(flag::large_strain);
  options.strain_progress = [&]() -> std::function<void()> {
    progress = std::make_shared<Progress>(arguments, "places pressed at large strain", 0);
    return [&progress] { progress->step(); };
  };
  const std::int64_t start = monotonic_ns();
  const PreparedBody body(mesh, model, options);
  progress.reset();
  in.within(mesh.nodes);
  tell_accuracy(arguments, "hs-simulate", body.field());
  const std::optional<ToolCoupling> coupling = couple_tools(arguments, in, mesh, model, body);
  in.metadata.set("off_contacts", format_number(body.field().expected_error()));
  say(arguments, "hs-simulate",
      fmt::format("ready in {:.2g} s: {} samples of the contact stiffness, between them {:.1f} % "
                  "expected; {} contacts solved finely",
                  1e-9 * static_cast<double>(monotonic_ns() - start), body.field().samples(),
                  100 * body.field().expected_error(), fine ? fine->dataset.positions.size() : 0));
  tell_large_strain(arguments, body);
  if (body.is_regional())
    say(arguments, "hs-simulate",
        fmt::format("regions relax each in its own way: {} Maxwell elements, within {:.1g} of the "
                    "stiffness",
                    body.terms().size(), body.misfit()));
  ToolLoopOptions loop_options = in.loop_options();
  loop_options.fitted = fitted_range(model.metadata, model.name);
  if (in.several) return answer_several(arguments, in, model, body, coupling, loop_options);
  ForceLoop loop(body, loop_options);
  return answer(arguments, in, effects_label(model), loop);
}

inline int run_live_acfm(const Arguments& arguments, const Acfm& model) {
  if (arguments.given(flag::uncertainty))
    fail_usage("--uncertainty is of finite elements, and this model has none", "leave it out");
  if (arguments.given(flag::large_strain))
    fail_usage("--large-strain is of finite elements, and this model has none", "leave it out");
  if (arguments.given(flag::contacts))
    fail_usage("--contacts is of finite elements, and this model has none", "leave it out");
  LiveInput in(arguments);
  if (in.several)
    fail_input(in.input.name(), "it is of several tools, or of one that turns",
               "an analytical model knows one tool that does not turn; leave out tool_id, thx, thy "
               "and thz");
  std::optional<SignedDistance> surface;
  if (arguments.given(flag::body)) {
    const TetMesh mesh = load_body(arguments);
    surface.emplace(boundary_surface(mesh), "body");
    in.within(mesh.nodes);
  }
  if (!surface && !in.has_contact_point())
    fail_input(in.input.name(),
               "its columns are those of a moving tip, whose contacts only a body shows",
               "give --body body.ply, or the columns press,t,x,y,z,ux,uy,uz");
  ToolLoopOptions loop_options = in.loop_options();
  loop_options.fitted = fitted_range(model.metadata, arguments[flag::model]);
  AcfmLoop loop(model, surface ? &*surface : nullptr, loop_options);
  return answer(arguments, in, "acfm", loop);
}

}  // namespace hapsim
