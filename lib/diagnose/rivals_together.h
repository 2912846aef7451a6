// Two effects that do equally well alone may be rivals, or may both be there.
#pragma once

#include "diagnose/candidate.h"

namespace hapsim {

// Both together leave noise and mesh alone, and each of the two plainly more than that: neither
// stands for the other. Of rivals the second adds nothing to the first.
bool both_act(const Candidate& a, const Candidate& b, const TrialGround& ground);

}  // namespace hapsim
