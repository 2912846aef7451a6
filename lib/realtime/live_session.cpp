#include "realtime/live_session.h"

#include <fmt/format.h>

#include <optional>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

// A press goes on where the recording says that the body does not recover, as in the batch mode.
bool goes_on(const MotionLine& last, const MotionLine& line) {
  return line.t >= last.t && (line.point - last.point).norm() <= 1e-4;
}

}  // namespace

std::string LiveReport::depth_summary() const {
  if (deep == 0) return "";
  return fmt::format(
      "{} of {} lines are deeper than the model was fitted to, or than {:.0f} % of the way through "
      "the body; of {} the force is held at {:.0f} %",
      deep, latency.count(), 100 * kValidShare, held, 100 * kHeldShare);
}

void run_live(MotionSource& in, std::ostream& out, ToolLoop& loop, const LiveOptions& options,
              LiveReport& report) {
  std::optional<Pacer> pacer;
  if (options.rate > 0) pacer.emplace(options.rate);
  MotionLine line, last;
  Vec3 untouched = Vec3::Zero();  // where it was nearest at first
  std::string text;
  text.reserve(512);
  for (bool first = true;; first = false) {
    std::int64_t since = pacer ? pacer->wait() : 0;
    if (!in.next(line)) break;
    if (!pacer) since = monotonic_ns();
    Vec3 force;
    loop.set_temperature(line.temperature);
    if (in.has_contact_point()) {
      const bool fresh = first || line.press != last.press;
      if (fresh && (first || !options.remembers || !goes_on(last, line))) loop.begin(line.point);
      force = loop.press(line.t, line.u, line.in_air);
      last = line;
    } else {
      force = loop.step(line.t, line.point);
      const ToolState& tool = loop.tool();
      // Every touch is a press. Away from the body a line belongs to the last one, at its contact
      // point; before the first, to a press of number 0 that never touches.
      if (first) untouched = tool.surface.point;
      line.press = tool.episode;
      line.in_air = !tool.touching();
      line.point = tool.episode == 0 ? untouched : tool.anchor;
    }
    line.u = loop.pressed();
    line.beyond = loop.beyond();
    line.uncertainty = loop.uncertainty() * force.norm();
    if (line.beyond & kBeyondPlaces) ++report.off;
    if (line.beyond & kBeyondHeld) ++report.held;
    if (line.beyond & (kBeyondDepth | kBeyondHeld)) ++report.deep;
    in.write_force(text, line, force);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    const std::int64_t took = monotonic_ns() - since;
    report.latency.add(took);
    if (pacer && took > pacer->period()) ++report.misses;
  }
}

}  // namespace hapsim
