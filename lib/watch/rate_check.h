// That the rows of a stream come as often as is said.
#pragma once

#include <string>

#include "realtime/motion_source.h"

namespace hapsim {

// Judges by the first fifty steps in time within presses: fewer than half of them between a half
// and twice the period are another rate.
class RateCheck {
 public:
  explicit RateCheck(double rate) : rate_(rate) {}  // [Hz]
  // The next row. Error(kBadInput) about the stream `name`: it comes at another rate, which is
  // named.
  void add(const MotionLine& line, const std::string& name);

 private:
  static constexpr int kSteps = 50;
  double rate_, shortest_ = 1e300;
  int steps_ = -1, within_ = 0;
  MotionLine last_;
};

}  // namespace hapsim
