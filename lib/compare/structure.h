// What the residual says in plain words, and only what the noise cannot say.
#pragma once

#include <string>
#include <vector>

#include "compare/breakdown.h"

namespace hapsim {

struct Observation {
  std::string kind;      // "overall", the grouping's name, "offset", "drift", "press" or
                         // "left"
  std::string sentence;  // "The error changes with depth: ..."
  double p_value = 1;    // corrected for all that was tried
  double share = 0;      // of the squared error beyond noise that it accounts for
};

// Finds structure step by step: of all that is significant the largest is told and taken off, then
// the rest is searched again, at most `most` times. Tried are a common gain, a gain for each bin of
// each grouping (Student's t on press-level variability, Bonferroni over the bins), gains of
// positions (Fisher's F of positions over presses of one position), a constant offset and an offset
// that drifts (intercepts of the presses). With nothing but noise a sentence appears in under 2 %
// of recordings (Bonferroni over all that is tried). With fewer than three presses only the noise
// is left to compare with, taken as white. Last comes what none of them takes away, where it is
// beyond the noise and neighbouring samples err alike: as gains of the presses, if these take away
// half of it.
std::vector<Observation> find_structure(const RowFacts& facts, const std::vector<Vec3>& measured,
                                        const std::vector<Vec3>& simulated, double noise,
                                        std::size_t most = 4);

}  // namespace hapsim
