// Two recordings fused as if they came in time, and the filter's parameters from them.
#pragma once

#include <string>
#include <vector>

#include "fusion/fusion.h"
#include "recording/recording.h"

namespace hapsim {

struct SlowSource {
  const Recording* recording = nullptr;
  double delay = 0;  // from a row's time until it is there [s]; a column `arrives` [s] goes before
  // The fast source pressed in the slow one's steps, row by row of `recording`; may be null. What
  // it gives there less than along the whole way is what seldom steps make of a body that relaxes,
  // and is taken off the slow forces.
  const Recording* stepped = nullptr;
};

struct FusedForces {
  std::vector<Vec3> force, deviation;  // one a row of the fast recording [N]
  std::vector<Vec3> held;              // the last slow force that was there [N]
  std::vector<Vec3> extrapolated;      // the last two, drawn on [N]
  FusionReport report;
};

// Row by row of `fast`: slow rows of the same press are observed once their arrival has passed, so
// nothing is known before it is there. A row in the air gives no force. Error(kBadInput): no
// times, slow presses that the fast recording does not have, an arrival before its time, `stepped`
// of other rows.
FusedForces fuse(const Recording& fast, const SlowSource& slow, const FusionParameters& parameters);

// The parameters under which the slow forces are most likely, each under what was given out for its
// time before it came (the logarithmic score of the forecasts; of innovations it is the likelihood
// of Schweppe, IEEE Trans. Inform. Theory 11, 1965); F is the largest fast force of the component;
// `blend` is left as it is. Error(kBadInput): fewer than 20 slow rows. Some thousand runs.
struct LearnedFusion {
  FusionParameters parameters;
  bool converged = false;
  int runs = 0;
};
LearnedFusion learn_fusion(const Recording& fast, const SlowSource& slow,
                           const FusionParameters& start);

// How forces differ from exact ones of the same rows.
struct ForceQuality {
  double rms = 0;           // per component, over the rows in contact [N]
  double largest_step = 0;  // between two rows of a press, to a millisecond [N]
};
ForceQuality force_quality(const Recording& motion, const std::vector<Vec3>& force,
                           const std::vector<Vec3>& exact);

}  // namespace hapsim
