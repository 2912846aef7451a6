// hs-compare --follow: a stream of measured forces watched against a model.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include "base/counted.h"
#include "base/error.h"
#include "cli/tool.h"
#include "experiment/contact_radius.h"
#include "formats/tetmesh_io.h"
#include "hs-compare/flags.h"
#include "io/csv.h"
#include "marked_points.h"
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
       .help = "Follow: false alarms an hour that are put up with, of each tool.",
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

// What is watched of one tool: its sensor is its own. A press beside which another tool has touched
// is left out from there on, for that one moves the surface that the model has at rest.
struct WatchedTool {
  WatchedTool(const PreparedBody& body, const WatchOptions& options)
      : watch(body, options), news(watch, options), rate(options.test.rate) {}
  bool takes(const MotionLine& line, bool alone) {
    if (!alone && !line.in_air) beside = line.press;
    return !beside || *beside != line.press;
  }

  ModelWatch watch;
  WatchNews news;
  RateCheck rate;
  long in_contact = 0;
  std::optional<int> beside;  // the press
};

inline int run_follow(const Arguments& arguments) {
  for (const AnyFlag& flag : AnyFlags{flag::body, flag::model})
    if (!arguments.given(flag)) fail_usage("--follow needs " + flag, "give it");
  for (const AnyFlag& flag : AnyFlags{flag::simulated, flag::html, flag::json, flag::ply,
                                      flag::fail_above, flag::markers, flag::simulated_markers})
    if (arguments.given(flag))
      fail_usage(flag + " is of whole recordings", "leave it out, or --follow");
  Input model_input(arguments[flag::model]);
  const Model model = read_model(model_input);
  Input body_input(arguments[flag::body]);
  const TetMesh mesh = read_body(body_input);
  Input input(arguments.input());
  MotionLines lines(input, true);
  lines.require_contact_points("press,t,x,y,z,ux,uy,uz,fx,fy,fz");
  lines.allow_tools();
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
  std::vector<std::unique_ptr<WatchedTool>> tools;
  const auto of_tool = [&](std::size_t k) {
    return lines.has_tools() ? "tool " + lines.tool_id(k) + ": " : std::string();
  };
  Metadata metadata = lines.metadata();
  metadata.set("simulated", effects_label(model) + ", followed");
  Output output(arguments.output());
  std::vector<std::string> header = kForceColumns;
  header.insert(header.end(), {"sx", "sy", "sz", "rx", "ry", "rz"});
  if (lines.has_tools()) header.emplace_back("tool_id");
  CsvWriter(output.stream(), metadata, header);
  output.stream().flush();
  const auto line_said = [&](const std::string& text) { say(arguments, "hs-compare", text); };
  MotionLine line;
  std::string text;
  long left_out = 0;
  const auto follow = [&](WatchedTool& tool) {
    tool.rate.add(line, input.name());
    if (!line.in_air) ++tool.in_contact;
    const Vec3 measured = lines.force();
    const Vec3 simulated = tool.watch.step(line, measured);
    write_force_line(text, line, measured);
    text.pop_back();
    append_columns(text, simulated);
    append_columns(text, measured - simulated);
    if (lines.has_tools()) text += ',' + lines.tool_id(lines.tool());
    output.stream() << text << '\n';
    output.stream().flush();
    for (const std::string& words : tool.news.next(line.t))
      line_said(of_tool(lines.tool()) + words);
  };
  answer_stream(
      arguments, "hs-compare", input,
      [&] {
        while (lines.next(line)) {
          if (lines.tool() == tools.size())
            tools.push_back(std::make_unique<WatchedTool>(body, watch_options));
          if (WatchedTool& tool = *tools[lines.tool()]; tool.takes(line, lines.is_alone()))
            follow(tool);
          else
            ++left_out;
        }
      },
      [&] {
        output.commit();
        std::vector<ToolEvents> events;
        for (std::size_t k = 0; k < tools.size(); ++k)
          events.push_back({lines.has_tools() ? lines.tool_id(k) : "", tools[k]->watch.events()});
        if (arguments.given(flag::events)) {
          Output table(arguments[flag::events]);
          write_events(table.stream(), events);
          table.commit();
        }
        for (std::size_t k = 0; k < tools.size(); ++k)
          if (tools[k]->watch.learned())
            line_said(of_tool(k) + counted(tools[k]->watch.events().size(), "change", "changes") +
                      " noticed");
      });
  if (left_out > 0)
    line_said(fmt::format("{} pressed beside another tool, which moves the surface: not watched",
                          counted(static_cast<std::size_t>(left_out), "line was", "lines were")));
  for (std::size_t k = 0; k < std::max<std::size_t>(tools.size(), 1); ++k)
    if (tools.empty() || !tools[k]->watch.learned())
      line_said(fmt::format(
          "{}nothing was watched: the usual error is learned from {:g} s in contact, and "
          "there were {:.3g} s; give a longer stream, or a shorter --learning",
          tools.empty() ? "" : of_tool(k), watch_options.test.learning,
          tools.empty() ? 0 : static_cast<double>(tools[k]->in_contact) / watch_options.test.rate));
  return 0;
}

}  // namespace hapsim
