// hs-compare --follow: a stream of measured forces watched against a model.
#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.h"
#include "base/error.h"
#include "cli/tool.h"
#include "formats/tetmesh_io.h"
#include "io/csv.h"
#include "mesh/tetmesh.h"
#include "model/model_edit.h"
#include "stream_options.h"
#include "watch/watch.h"

namespace hapsim {

inline std::vector<Option> follow_flags() {
  return {
      {.flag = "--follow",
       .kind = OptionKind::kSwitch,
       .help = "Watches a stream: each row is compared with --model on --body as it comes.",
       .group = "Follow"},
      {.flag = "--tool-radius",
       .kind = OptionKind::kLength,
       .value = "M",
       .help = "Follow: radius of the flat tool [m]; otherwise the stream's metadata.",
       .group = "Follow",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = "--rate",
       .kind = OptionKind::kNumber,
       .value = "HZ",
       .help = "Follow: rows a second.",
       .group = "Follow",
       .default_text = "1000",
       .minimum = 1,
       .maximum = 100000},
      {.flag = "--learning",
       .kind = OptionKind::kTime,
       .value = "S",
       .help = "Follow: time in contact, at the beginning, in which the usual error is learned.",
       .group = "Follow",
       .default_text = "5",
       .minimum = 0.5,
       .maximum = 36000},
      {.flag = "--false-alarms",
       .kind = OptionKind::kNumber,
       .value = "N",
       .help = "Follow: false alarms an hour that are put up with.",
       .group = "Follow",
       .default_text = "0.1",
       .minimum = 1e-6,
       .maximum = 100},
      {.flag = "--events",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Follow: writes what has changed, and how the model went on (CSV).",
       .group = "Follow",
       .writes = kTableExtensions},
      {.flag = "--hold",
       .kind = OptionKind::kSwitch,
       .help = "Follow: alarms are told and the model stays as it is.",
       .group = "Follow"}};
}

// That rows come as often as --rate says: the test counts them.
class RateCheck {
 public:
  explicit RateCheck(double rate) : rate_(rate) {}
  void add(const MotionLine& line, const std::string& name) {
    if (steps_ == kSteps) return;
    const double step = line.t - last_.t;
    if (steps_ >= 0 && line.press == last_.press && step > 0) {
      within_ += step * rate_ > 0.5 && step * rate_ < 2 ? 1 : 0;
      shortest_ = std::min(shortest_, step);
      if (++steps_ == kSteps && within_ < kSteps / 2)
        fail_input(name,
                   fmt::format("the rows come at some {:.3g} Hz by their t, not {:g} Hz",
                               1 / shortest_, rate_),
                   "give that as --rate, or t in seconds");
    }
    steps_ = std::max(steps_, 0);
    last_ = line;
  }

 private:
  static constexpr int kSteps = 50;
  double rate_, shortest_ = 1e300;
  int steps_ = -1, within_ = 0;
  MotionLine last_;
};

inline std::string usual_words(const ModelWatch& watch, const WatchOptions& options) {
  return fmt::format(
      "usual error {:.3g} N; alarm when the cumulative sum is above {:.3g}, {:g} false ones an "
      "hour; a change of the stiffness by less than {:.2g} % goes unnoticed",
      watch.usual_error(), watch.limit(), options.test.false_alarms, 100 * watch.least_change());
}

// What a change that is refined has come to; empty where there is nothing to say.
inline std::string refined_words(const WatchEvent& e, double t) {
  const std::string rest =
      e.explains() ? ""
                   : fmt::format(
                         "; the error stays {:.2g} times the usual, so this does not explain "
                         "it: scan the body where it is now, or identify it anew",
                         e.error_with / e.error_before);
  if (e.change == Change::kMoved)
    return fmt::format(
               "{:.3f} s: shift by ({:.2f}, {:.2f}, {:.2f}) mm after {} presses, standard error "
               "({:.2g}, {:.2g}, {:.2g}) mm; the usual error is learned anew",
               t, 1e3 * e.correction.shift.x(), 1e3 * e.correction.shift.y(),
               1e3 * e.correction.shift.z(), e.presses, 1e3 * e.shift_error.x(),
               1e3 * e.shift_error.y(), 1e3 * e.shift_error.z()) +
           rest;
  if (e.change == Change::kMaterial && e.presses > 0)
    return fmt::format(
               "{:.3f} s: stiffness by a factor {:.3g}, what relaxes by {:.3g} beside that and its "
               "times by {:.3g} after {} presses; error {:.3g} N",
               t, e.correction.stiffness, e.correction.relaxation, e.correction.slowness, e.presses,
               e.error_with) +
           rest;
  return {};
}

inline void write_events(const std::string& path, const ModelWatch& watch) {
  Output events(path);
  CsvWriter csv(events.stream(), {},
                {"begun", "alarm", "named", "change", "stiffness", "bias_x", "bias_y", "bias_z",
                 "shift_x", "shift_y", "shift_z", "error", "shift_error_x", "shift_error_y",
                 "shift_error_z", "presses", "updated", "relaxation", "slowness"});
  for (const WatchEvent& e : watch.events()) {
    std::vector<std::string> row{format_number(e.begun), format_number(e.alarm),
                                 format_number(e.named), change_name(e.change),
                                 format_number(e.correction.gone ? 0 : e.correction.stiffness)};
    for (const Vec3* v : {&e.correction.bias, &e.correction.shift})
      for (int k = 0; k < 3; ++k) row.push_back(format_number((*v)[k]));
    row.push_back(format_number(e.error_with));
    for (int k = 0; k < 3; ++k) row.push_back(format_number(e.shift_error[k]));
    row.push_back(std::to_string(e.presses));
    row.push_back(e.updated < 0 ? "" : format_number(e.updated));
    row.push_back(format_number(e.correction.relaxation));
    row.push_back(format_number(e.correction.slowness));
    csv.row(row);
  }
  events.commit();
}

inline int run_follow(const Arguments& arguments) {
  for (const char* flag : {"--body", "--model"})
    if (!arguments.given(flag)) fail_usage(std::string("--follow needs ") + flag, "give it");
  for (const char* flag : {"--simulated", "--html", "--json", "--ply", "--fail-above"})
    if (arguments.given(flag))
      fail_usage(std::string(flag) + " is of whole recordings", "leave it out, or --follow");
  Input model_input(arguments.text("--model"));
  const Model model = read_model(model_input);
  Input body_input(arguments.text("--body"));
  const TetMesh mesh = read_body(body_input);
  Input input(arguments.input());
  MotionLines lines(input, true);
  require_contact_points(lines, input.name(), "press,t,x,y,z,ux,uy,uz,fx,fy,fz");
  PreparedBodyOptions options;
  options.tool_radius = stream_radius(arguments, lines.metadata(), input.name());
  keep_within(lines, mesh);
  const PreparedBody body(mesh, model, options);
  WatchOptions watch_options;
  watch_options.test.rate = arguments.number("--rate");
  watch_options.test.learning = arguments.number("--learning");
  watch_options.test.false_alarms = arguments.number("--false-alarms");
  watch_options.adapts = !arguments.given("--hold");
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
  std::size_t told = 0, refined = 0;  // events
  long rows = 0, in_contact = 0;
  bool learned = false;
  RateCheck rate_check(watch_options.test.rate);
  const auto tell_news = [&] {
    if (!learned && watch.learned()) {
      learned = true;
      line_said(usual_words(watch, watch_options));
    }
    if (refined < watch.events().size() && watch.events()[refined].settled)
      if (const std::string words = refined_words(watch.events()[refined++], line.t);
          !words.empty())
        line_said(words);
    for (; told < watch.events().size(); ++told) {
      const WatchEvent& e = watch.events()[told];
      line_said(fmt::format(
          "{:.3f} s: {} since about {:.3f} s (alarm at {:.3f} s); error {:.3g} N "
          "with the correction, usually {:.3g} N",
          e.named, change_name(e.change), e.begun, e.alarm, e.error_with, e.error_before));
    }
  };
  answer_stream(
      arguments, "hs-compare", input,
      [&] {
        for (; lines.next(line); ++rows) {
          rate_check.add(line, input.name());
          if (!line.in_air) ++in_contact;
          const Vec3 measured = lines.force();
          const Vec3 simulated = watch.step(line, measured);
          write_force_line(text, line, measured);
          text.pop_back();
          for (const Vec3& v : {simulated, Vec3(measured - simulated)})
            for (int k = 0; k < 3; ++k) text += ',' + format_number(v[k] == 0 ? 0.0 : v[k]);
          output.stream() << text << '\n';
          output.stream().flush();
          tell_news();
        }
      },
      [&] {
        output.commit();
        if (arguments.given("--events")) write_events(arguments.text("--events"), watch);
        if (learned) line_said(counted(watch.events().size(), "change", "changes") + " noticed");
      });
  if (!learned)
    line_said(fmt::format(
        "nothing was watched: the usual error is learned from {:g} s in contact, and "
        "there were {:.3g} s; give a longer stream, or a shorter --learning",
        watch_options.test.learning, static_cast<double>(in_contact) / watch_options.test.rate));
  return 0;
}

}  // namespace hapsim
