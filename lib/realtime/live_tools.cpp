#include "realtime/live_tools.h"

#include <optional>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

// Presses as SeveralTools counts them: one that goes on from the last, at its place, is the same.
class ToolPresses {
 public:
  explicit ToolPresses(bool remembers) : remembers_(remembers) {}
  void number(ToolStep& step) {
    for (std::size_t k = 0; k < kMostTools; ++k) {
      if (!step.present[k]) continue;
      ToolPose& pose = step.pose[k];
      Last& last = last_[k];
      const bool goes_on =
          last.begun && remembers_ && step.t >= last.t && (pose.point - last.point).norm() <= 1e-4;
      if (!last.begun || (pose.press != last.press && !goes_on)) ++last.count;
      last = {true, pose.press, last.count, step.t, pose.point};
      pose.press = last.count;
    }
  }
  int told(std::size_t tool) const { return last_[tool].press; }

 private:
  struct Last {
    bool begun = false;
    int press = 0, count = 0;
    double t = 0;
    Vec3 point = Vec3::Zero();
  };
  bool remembers_;
  std::array<Last, kMostTools> last_;
};

}  // namespace

void run_live_tools(ToolSource& in, std::ostream& out, SeveralTools& tools,
                    const LiveOptions& options, LiveReport& report) {
  std::optional<Pacer> pacer;
  if (options.rate > 0) pacer.emplace(options.rate);
  ToolPresses presses(options.remembers);
  ToolStep step;
  std::array<ToolFeel, kMostTools> answer;
  std::string text;
  text.reserve(2048);
  for (;;) {
    std::int64_t since = pacer ? pacer->wait() : 0;
    if (!in.next(step)) break;
    if (!pacer) since = monotonic_ns();
    tools.set_temperature(step.temperature);
    const std::span<const ToolPose> poses(step.pose.data(), tools.tools());
    std::span<const ToolFeel> feel;
    if (in.has_contact_point()) {
      presses.number(step);
      feel = tools.press(step.t, poses);
    } else {
      feel = tools.step(step.t, poses);
    }
    for (std::size_t k = 0; k < feel.size(); ++k) {
      answer[k] = feel[k];
      if (in.has_contact_point()) answer[k].press = presses.told(k);
      report.count(feel[k].beyond);
    }
    in.write(text, step, {answer.data(), feel.size()});
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    const std::int64_t took = monotonic_ns() - since;
    report.latency.add(took);
    if (pacer && took > pacer->period()) ++report.misses;
  }
}

}  // namespace hapsim
