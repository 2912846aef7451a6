#include "realtime/live_session.h"

#include <fmt/format.h>

#include <bit>
#include <optional>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

// A press goes on where the recording says that the body does not recover, as in the batch mode.
bool goes_on(const MotionLine& last, const MotionLine& line) {
  return line.t >= last.t && (line.point - last.point).norm() <= 1e-4;
}

}  // namespace

void LiveReport::count(int bits) noexcept {
  for (std::size_t k = 0; k < beyond.size(); ++k) beyond[k] += bits >> k & 1;
  deep += bits & (kBeyondDepth | kBeyondHeld) ? 1 : 0;
}

std::vector<std::string> LiveReport::beyond_words() const {
  std::vector<std::string> words;
  const auto of = [this](Beyond bit) {
    return beyond[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(bit)))];
  };
  const auto say = [&](std::int64_t lines, const std::string& what) {
    if (lines > 0) words.push_back(fmt::format("{} of {} lines {}", lines, latency.count(), what));
  };
  say(of(kBeyondPlaces),
      "press where no contact mesh can be made, beside the support: their forces are extrapolated");
  say(deep, fmt::format("are deeper than the model was fitted to, or than {:.0f} % of the way "
                        "through the body; of {} the force is held at {:.0f} %",
                        100 * kValidShare, of(kBeyondHeld), 100 * kHeldShare));
  say(of(kBeyondFitted), "press away from the places that the model was fitted to");
  say(of(kBeyondSpeed), "move faster than the model was fitted to");
  say(of(kBeyondLaw), "go farther into the body or along it than the model's law was verified");
  return words;
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
    line.uncertainty = line.in_air ? 0 : loop.uncertainty() * force.norm();
    report.count(line.beyond);
    in.write_force(text, line, force);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    const std::int64_t took = monotonic_ns() - since;
    report.latency.add(took);
    if (pacer && took > pacer->period()) ++report.misses;
  }
}

}  // namespace hapsim
