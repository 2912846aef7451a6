// A force that is there without any displacement: a sensor's zero that is off, or wanders.
#pragma once

#include <string>
#include <vector>

#include "compare/residuals.h"

namespace hapsim {

struct OffsetHypothesis {
  std::string name;             // "offset", "drift"
  std::string sentence;         // empty when the recording cannot tell
  double p_value = 1;           // corrected for the three components
  double explained = 0;         // squared error it takes off, less what chance takes [N^2]
  std::vector<Vec3> corrected;  // the simulated force with it [N]
};

// Each press is fitted as measured = g simulated + b; the intercepts b of the presses are tested
// for a mean that is not zero, and for a slope along the session, by Student's t (three components,
// Bonferroni). Needs four presses whose force changes, for the slope five and a time column; else
// empty.
std::vector<OffsetHypothesis> try_offsets(const RowFacts& facts, const std::vector<Vec3>& measured,
                                          const std::vector<Vec3>& simulated, double noise);

}  // namespace hapsim
