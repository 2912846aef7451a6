#include "watch/watch_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/csv.h"

namespace hapsim {

std::string usual_words(const ModelWatch& watch, const WatchOptions& options) {
  if (!std::isfinite(watch.least_change()))
    return "the stream has the model's own forces, without any error: no change can be told";
  return fmt::format(
      "usual error {:.3g} N; alarm when the cumulative sum is above {:.3g}, {:g} false ones an "
      "hour; a change of the stiffness by less than {:.2g} % goes unnoticed",
      watch.usual_error(), watch.limit(), options.test.false_alarms, 100 * watch.least_change());
}

std::string named_words(const WatchEvent& e) {
  return fmt::format(
      "{:.3f} s: {} since about {:.3f} s (alarm at {:.3f} s); error {:.3g} N "
      "with the correction, usually {:.3g} N",
      e.named, change_name(e.change), e.begun, e.alarm, e.error_with, e.error_before);
}

std::string refined_words(const WatchEvent& e, double t) {
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

std::vector<std::string> WatchNews::next(double t) {
  const std::vector<WatchEvent>& events = watch_.events();
  std::vector<std::string> lines;
  if (!learned_ && watch_.learned()) {
    learned_ = true;
    lines.push_back(usual_words(watch_, options_));
  }
  if (refined_ < events.size() && events[refined_].settled)
    if (const std::string words = refined_words(events[refined_++], t); !words.empty())
      lines.push_back(words);
  for (; told_ < events.size(); ++told_) lines.push_back(named_words(events[told_]));
  return lines;
}

void write_events(std::ostream& out, const std::vector<ToolEvents>& tools) {
  std::vector<std::string> header{"begun",         "alarm",         "named",         "change",
                                  "stiffness",     "bias_x",        "bias_y",        "bias_z",
                                  "shift_x",       "shift_y",       "shift_z",       "error",
                                  "shift_error_x", "shift_error_y", "shift_error_z", "presses",
                                  "updated",       "relaxation",    "slowness"};
  const bool named = std::any_of(tools.begin(), tools.end(),
                                 [](const ToolEvents& tool) { return !tool.tool_id.empty(); });
  if (named) header.emplace_back("tool_id");
  CsvWriter csv(out, {}, header);
  for (const ToolEvents& tool : tools)
    for (const WatchEvent& e : tool.events) {
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
      if (named) row.push_back(tool.tool_id);
      csv.row(row);
    }
}

}  // namespace hapsim
