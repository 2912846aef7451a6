// Single samples that err far beyond the noise, always at the same part of the presses.
#pragma once

#include <Eigen/Core>

#include "experiment/dataset.h"

namespace hapsim {

// Each press is cut in kParts by its samples. Samples that are off by kFarOff times the noise come
// at any part if they are outliers; where a part has them in more presses than chance does once in
// ten thousand recordings (binomial, of presses that have some there), something happens there.
struct LockedEvents {
  static constexpr int kParts = 25;
  static constexpr double kFarOff = 6;
  int presses = 0, of = 0;     // that have such samples at that part
  double from = 0, until = 0;  // of a press's samples, in shares
  bool found = false;
};

// `residual` [N], stacked.
LockedEvents find_locked_events(const Dataset& dataset, const Eigen::VectorXd& residual,
                                double noise);

}  // namespace hapsim
