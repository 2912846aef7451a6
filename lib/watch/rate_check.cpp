#include "watch/rate_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace hapsim {

void RateCheck::add(const MotionLine& line, const std::string& name) {
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

}  // namespace hapsim
