// hs-compare --follow: a stream of measured forces watched against a model.
#pragma once

#include <fmt/format.h>

#include "base/counted.h"
#include "base/error.h"
#include "cli/tool.h"
#include "experiment/contact_radius.h"
#include "formats/tetmesh_io.h"
#include "hs-compare/flags.h"
#include "io/csv.h"
#include "mesh/tetmesh.h"
#include "model/model_edit.h"
#include "prepared_options.h"
#include "realtime/motion_lines.h"
#include "stream_options.h"
#include "watch/rate_check.h"
#include "watch/watch_words.h"

namespace hapsim {

inline std::vector<Option> follow_flags() {
  return {
      {.flag = flag::follow,
       .help = "Watches a stream: each row is compared with --model on --body as it comes.",
       .group = "Follow"},
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Follow: radius of the flat tool [m]; otherwise the stream's metadata.",
       .group = "Follow",
       .minimum = 1e-6,
       .maximum = 1},
      accuracy_option("Follow"),
      {.flag = flag::rate,
       .value = "HZ",
       .help = "Follow: rows a second.",
       .group = "Follow",
       .default_text = "1000",
       .minimum = 1,
       .maximum = 100000},
      {.flag = flag::learning,
       .value = "S",
       .help = "Follow: time in contact, at the beginning, in which the usual error is learned.",
       .group = "Follow",
       .default_text = "5",
       .minimum = 0.5,
       .maximum = 36000},
      {.flag = flag::false_alarms,
       .value = "N",
       .help = "Follow: false alarms an hour that are put up with.",
       .group = "Follow",
       .default_text = "0.1",
       .minimum = 1e-6,
       .maximum = 100},
      {.flag = flag::events,
       .value = "FILE",
       .help = "Follow: writes what has changed, and how the model went on (CSV).",
       .group = "Follow",
       .writes = kTableExtensions},
      {.flag = flag::hold,
       .help = "Follow: alarms are told and the model stays as it is.",
       .group = "Follow"}};
}

inline int run_follow(const Arguments& arguments) {
  for (const AnyFlag& flag : AnyFlags{flag::body, flag::model})
    if (!arguments.given(flag)) fail_usage("--follow needs " + flag, "give it");
  for (const AnyFlag& flag :
       AnyFlags{flag::simulated, flag::html, flag::json, flag::ply, flag::fail_above})
    if (arguments.given(flag))
      fail_usage(flag + " is of whole recordings", "leave it out, or --follow");
  Input model_input(arguments[flag::model]);
  const Model model = read_model(model_input);
  Input body_input(arguments[flag::body]);
  const TetMesh mesh = read_body(body_input);
  Input input(arguments.input());
  MotionLines lines(input, true);
  lines.require_contact_points("press,t,x,y,z,ux,uy,uz,fx,fy,fz");
  std::shared_ptr<Progress> progress;
  PreparedBodyOptions options = prepared_options(
      arguments, contact_radius(model, stream_radius(arguments, lines.metadata(), input.name())),
      progress);
  lines.within(mesh.nodes);
  options.heals = lines.metadata().find("recovery").value_or("") == "full";
  const PreparedBody body(mesh, model, options);
  progress.reset();
  tell_accuracy(arguments, "hs-compare", body.field());
  WatchOptions watch_options;
  watch_options.test.rate = arguments[flag::rate];
  watch_options.test.learning = arguments[flag::learning];
  watch_options.test.false_alarms = arguments[flag::false_alarms];
  watch_options.adapts = !arguments[flag::hold];
  ModelWatch watch(body, watch_options);
  Metadata metadata = lines.metadata();
  metadata.set("simulated", effects_label(model) + ", followed");
  Output output(arguments.output());
  std::vector<std::string> header = kForceColumns;
  header.insert(header.end(), {"sx", "sy", "sz", "rx", "ry", "rz"});
  CsvWriter(output.stream(), metadata, header);
  output.stream().flush();
  const auto line_said = [&](const std::string& text) { say(arguments, "hs-compare", text); };
  MotionLine line;
  std::string text;
  long in_contact = 0;
  RateCheck rate_check(watch_options.test.rate);
  WatchNews news(watch, watch_options);
  answer_stream(
      arguments, "hs-compare", input,
      [&] {
        while (lines.next(line)) {
          rate_check.add(line, input.name());
          if (!line.in_air) ++in_contact;
          const Vec3 measured = lines.force();
          const Vec3 simulated = watch.step(line, measured);
          write_force_line(text, line, measured);
          text.pop_back();
          append_columns(text, simulated);
          append_columns(text, measured - simulated);
          output.stream() << text << '\n';
          output.stream().flush();
          for (const std::string& words : news.next(line.t)) line_said(words);
        }
      },
      [&] {
        output.commit();
        if (arguments.given(flag::events)) {
          Output events(arguments[flag::events]);
          write_events(events.stream(), watch.events());
          events.commit();
        }
        if (watch.learned())
          line_said(counted(watch.events().size(), "change", "changes") + " noticed");
      });
  if (!watch.learned())
    line_said(fmt::format(
        "nothing was watched: the usual error is learned from {:g} s in contact, and "
        "there were {:.3g} s; give a longer stream, or a shorter --learning",
        watch_options.test.learning, static_cast<double>(in_contact) / watch_options.test.rate));
  return 0;
}

}  // namespace hapsim
