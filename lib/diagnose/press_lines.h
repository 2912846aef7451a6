// A line of its own in each press, as of a heart or a breath whose rate changes.
#pragma once

#include <Eigen/Core>

#include "experiment/dataset.h"

namespace hapsim {

struct PressLines {
  double share = 0;                 // foretold, of the squares beyond noise
  double slowest = 0, fastest = 0;  // the middle half of the presses' frequencies [Hz]
};

// Of `residual` (stacked forces of all presses): in each press a sine and a cosine beside a
// parabola, of the frequency that takes most of two thirds of its stretches, foretell the third;
// what they take off more than the parabola alone. A line has two periods in its press at least,
// and more than two samples in a period (of 300 in a press at most). Presses of fewer than three
// stretches, or of no time, have none. `noise` [N].
PressLines find_press_lines(const Eigen::VectorXd& residual, const Dataset& dataset, double noise);

}  // namespace hapsim
