// A line in the spectrum of what a model leaves, all the time or for a while.
#pragma once

#include <Eigen/Core>

#include "experiment/dataset.h"

namespace hapsim {

struct LineLeft {
  double frequency = 0;        // [Hz]; 0: none
  double from = 0, until = 0;  // of the presses that have it [s]
  bool always = true;          // it stands out of the whole session
};

// The line of `residual` (stacked forces of all presses) which stands out (find_line()) of a
// quarter of the session that has five eighths of all squares, or a half that has three quarters,
// where a sine and a cosine take most of them; else out of the whole session. None where the
// recording has no time that goes on from press to press.
LineLeft find_line_left(const Eigen::VectorXd& residual, const Dataset& dataset);

// The frequency [Hz] about which a residual swings that has no line (it comes and goes, or runs
// through frequencies): where each sample is foretold by the two before it, to most of what is
// beyond `noise` [N], as of a swing that is damped (autoregression of second order: Yule, Phil.
// Trans. A 226, 1927). 0 where it does not.
double swing_left(const Eigen::VectorXd& residual, const Dataset& dataset, double noise);

}  // namespace hapsim
