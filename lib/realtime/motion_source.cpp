#include "realtime/motion_source.h"

#include <fmt/format.h>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

// As in recordings: beyond these the unit is wrong [m].
constexpr double kLargestPosition = 10, kLargestDisplacement = 1, kSamePoint = 1e-4;

}  // namespace

void MotionCheck::check(const MotionLine& line, const std::function<std::string()>& where) {
  if (!(line.point.cwiseAbs().maxCoeff() <= kLargestPosition) ||
      !(line.u.cwiseAbs().maxCoeff() <= kLargestDisplacement))
    fail_input(where(), "a position beyond 10 m or a displacement beyond 1 m",
               "are these millimetres? divide lengths by 1000");
  if (bounded_ && line.has_contact_point) {
    const double size = (high_ - low_).norm();
    if (!line.in_air && !(line.u.norm() <= size))
      fail_input(
          where(),
          fmt::format("a displacement of {:.3g} m on a body of {:.3g} m", line.u.norm(), size),
          "correct or remove the row; all lengths are in metres");
    const Vec3 off = line.point - line.point.cwiseMax(low_).cwiseMin(high_);
    if (!(off.norm() <= size))
      fail_input(where(), "the contact point lies far off the body",
                 "check the frame and the unit [m]");
  }
  const bool goes_on = !first_ && (!line.has_contact_point || line.press == last_.press);
  if (goes_on && line.t < last_.t)
    fail_input(where(),
               "time runs backwards: " + format_number(line.t) + " s after " +
                   format_number(last_.t) + " s",
               "send the samples in their order, or begin a new press");
  if (goes_on && line.has_contact_point && (line.point - last_.point).norm() > kSamePoint)
    fail_input(where(), "the contact point moves within press " + std::to_string(line.press),
               "give each contact point its own press number");
  last_ = line;
  first_ = false;
}

void MotionCheck::within(const std::vector<Vec3>& nodes) {
  bounded_ = true;
  low_ = high_ = nodes.front();
  for (const Vec3& node : nodes) low_ = low_.cwiseMin(node), high_ = high_.cwiseMax(node);
}

}  // namespace hapsim
