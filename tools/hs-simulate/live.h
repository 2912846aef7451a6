// hs-simulate --live: motion in, forces out at once.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "acfm/acfm_loop.h"
#include "base/error.h"
#include "common_options.h"
#include "hs-simulate/flags.h"
#include "model/model_edit.h"
#include "realtime/force_loop.h"
#include "realtime/live_session.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
#include "realtime/real_time.h"
#include "stream_options.h"

namespace hapsim {

// The positions of --contacts, to be solved finely for any material. `progress` must outlive it.
inline std::optional<Experiment> fine_contacts(const Arguments& arguments, const TetMesh& body,
                                               const Model& model,
                                               std::shared_ptr<Progress>& progress) {
  if (!arguments.given(flag::contacts)) return std::nullopt;
  ExperimentOptions options = experiment_options(arguments, progress);
  set_poisson_range(model, options);
  return make_experiment(body, load_recording(arguments, arguments[flag::contacts], false),
                         options);
}

// Where the motion comes from.
struct LiveInput {
  explicit LiveInput(const Arguments& arguments) : input(arguments.input()) {
    if (arguments.given(flag::add_noise))
      fail_usage("--add-noise is of the batch mode", "leave it out, or --live");
    binary = arguments.given(flag::binary);
    if (binary) {
      source = std::make_unique<MotionRecords>(input, arguments[flag::binary] == "tip"
                                                          ? MotionRecords::Kind::kTip
                                                          : MotionRecords::Kind::kPress);
      return;
    }
    auto lines = std::make_unique<MotionLines>(input);
    metadata = lines->metadata();
    columns = lines->force_columns();
    source = std::move(lines);
  }
  bool remembers() const { return metadata.find("recovery").value_or("") == "none"; }
  bool heals() const { return metadata.find("recovery").value_or("") == "full"; }
  ToolLoopOptions loop_options() const {
    ToolLoopOptions options;
    options.relaxed = source->has_contact_point() || !remembers();
    return options;
  }

  Input input;
  bool binary = false;
  std::unique_ptr<MotionSource> source;
  Metadata metadata;                 // binary motion has none
  std::vector<std::string> columns;  // of the answers; records have none
};

// Answers every line until the motion ends.
inline int answer(const Arguments& arguments, LiveInput& in, const std::string& label,
                  ToolLoop& loop) {
  LiveOptions live;
  if (arguments.has(flag::rate)) live.rate = arguments[flag::rate];
  live.remembers = in.remembers();
  if (live.rate > 0) {
    widen_pipes();
    say(arguments, "hs-simulate", enter_real_time());
  }
  in.metadata.remove("force_noise");
  in.metadata.set("simulated", label);
  Output output(arguments.output());
  if (!in.binary) CsvWriter(output.stream(), in.metadata, in.columns);
  output.stream().flush();
  LiveReport report;
  answer_stream(
      arguments, "hs-simulate", in.input,
      [&] { run_live(*in.source, output.stream(), loop, live, report); },
      [&] {
        output.commit();
        std::string text = report.latency.summary();
        if (live.rate > 0)
          text +=
              fmt::format("; {} of {} later than a period", report.misses, report.latency.count());
        say(arguments, "hs-simulate", text);
        if (const std::string deep = report.depth_summary(); !deep.empty())
          say(arguments, "hs-simulate", deep);
      });
  return 0;
}

inline int run_live_mode(const Arguments& arguments, const Model& model) {
  const TetMesh mesh = load_body(arguments);
  LiveInput in(arguments);
  PreparedBodyOptions options;
  options.tool_radius = stream_radius(arguments, in.metadata, arguments.input());
  std::shared_ptr<Progress> progress;
  const std::optional<Experiment> fine = fine_contacts(arguments, mesh, model, progress);
  progress.reset();
  if (fine)
    options.contacts = [&](const MaterialSpec& material) {
      return known_contacts(fine->places, material);
    };
  options.heals = in.heals();
  const std::int64_t start = monotonic_ns();
  const PreparedBody body(mesh, model, options);
  in.source->within(mesh.nodes);
  say(arguments, "hs-simulate",
      fmt::format("{} surface unknowns condensed in {:.1f} ms, {} contacts solved finely",
                  body.surface_unknowns(), 1e-6 * static_cast<double>(monotonic_ns() - start),
                  fine ? fine->dataset.positions.size() : 0));
  if (body.is_regional())
    say(arguments, "hs-simulate",
        fmt::format("regions relax each in its own way: {} Maxwell elements, within {:.1g} of the "
                    "stiffness",
                    body.terms().size(), body.misfit()));
  ToolLoopOptions loop_options = in.loop_options();
  loop_options.fitted_depth = fitted_depth(model);
  ForceLoop loop(body, loop_options);
  return answer(arguments, in, effects_label(model), loop);
}

inline int run_live_acfm(const Arguments& arguments, const Acfm& model) {
  if (arguments.given(flag::contacts))
    fail_usage("--contacts is of finite elements, and this model has none", "leave it out");
  LiveInput in(arguments);
  std::optional<SignedDistance> surface;
  if (arguments.given(flag::body)) {
    const TetMesh mesh = load_body(arguments);
    surface.emplace(boundary_surface(mesh), "body");
    in.source->within(mesh.nodes);
  }
  if (!surface && !in.source->has_contact_point())
    fail_input(in.input.name(),
               "its columns are those of a moving tip, whose contacts only a body shows",
               "give --body body.ply, or the columns press,t,x,y,z,ux,uy,uz");
  AcfmLoop loop(model, surface ? &*surface : nullptr, in.loop_options());
  return answer(arguments, in, "acfm", loop);
}

}  // namespace hapsim
