// The trials of the identification.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "table.h"

namespace hapsim::bench {

using Draw = std::function<std::vector<Result>(int draw)>;  // of one draw of the noise; thread-safe

struct Case {
  std::string name;
  int draws = 1;
  std::function<Draw(const std::string& out)> prepare;  // what all draws share
};

// E and nu from presses along the normal and aslant: noise of 2 % of the peak, and each position's
// stiffness in error by what the fit is told to allow for (`floor`), or by nothing.
std::vector<Case> elastic_cases();
// Two Maxwell terms, 0.3 s and 10 s, held 20 s (noise 1 %): values; how many terms are chosen of
// three; held 2 s: whether the long time is said not to be identifiable.
std::vector<Case> viscoelastic_cases();
// Regions on the block by location samples, clusters and boundary, then refined.
std::vector<Case> region_cases();
// A stiff ball under a grid of positions by stiffness imaging.
std::vector<Case> imaging_cases();

}  // namespace hapsim::bench
