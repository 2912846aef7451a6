// What a model leaves of marked points, in words.
#pragma once

#include <string>
#include <vector>

#include "experiment/markers.h"

namespace hapsim {

// No more is left than noise and meshes, or no points counted. Where their noise was measured from
// the data, which is too small where it has a colour, more is let pass.
bool marker_explained(const MarkerError& error);
// Lines for people: the error over all, of the worst point, and whether points do not follow the
// tool in proportion.
std::vector<std::string> marker_facts(const MarkerError& error);

}  // namespace hapsim
