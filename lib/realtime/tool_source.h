// The motions of one or more tools, step by step, and the answers to them, however they are
// written.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "realtime/motion_source.h"
#include "realtime/several_tools.h"

namespace hapsim {

// All tools at one time. Of a tool that is not `present` nothing came: as a tip it is where it was,
// as a press in the air; its point is not finite.
struct ToolStep {
  double t = 0;  // [s]
  double temperature = std::numeric_limits<double>::quiet_NaN();
  std::array<ToolPose, kMostTools> pose;
  std::array<char, kMostTools> present{};
  // The tools of its lines as they came.
  std::array<std::size_t, kMostTools> order{};
  std::size_t rows = 0;
};

class ToolSource {
 public:
  virtual ~ToolSource() = default;
  virtual std::size_t tools() const = 0;
  virtual bool has_contact_point() const = 0;  // SeveralTools::press(), else step()
  // The next step, false at the end. Error(kBadInput) with its place as MotionSource::next().
  virtual bool next(ToolStep& step) = 0;
  // The bytes that answer it, in place of `buffer`, which keeps its memory.
  virtual void write(std::string& buffer, const ToolStep& step,
                     std::span<const ToolFeel> feel) const = 0;
  // For hands (SeveralTools's feel with its `safety`): whether answers may come that nobody has
  // asked for, while no motion comes.
  virtual bool takes_unasked() const { return true; }
  // As MotionSource::within().
  void within(const std::vector<Vec3>& nodes) {
    for (MotionCheck& check : check_) check.within(nodes);
  }

 protected:
  // Of one tool's part of a step.
  template <class Where>
  void check(std::size_t tool, const ToolStep& step, const Where& where) {
    MotionLine line;
    const ToolPose& pose = step.pose[tool];
    line.has_contact_point = has_contact_point();
    line.press = pose.press;
    line.t = step.t;
    line.point = pose.point;
    line.u = pose.u;
    line.in_air = pose.in_air;
    check_[tool].check(line, where);
  }

 private:
  std::array<MotionCheck, kMostTools> check_;
};

}  // namespace hapsim
