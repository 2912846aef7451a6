// Clusters of samples that are but the border between two regions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

// A press beside a border is held by both sides, so what it asks for lies between theirs. Such
// presses in a row look like a region of their own. A cluster all of whose places have a softer
// and a stiffer cluster as neighbours (Gabriel and Sokal, Syst. Zool. 18, 1969: nothing lies within
// the ball that two neighbours span) and values between these two is dissolved: each of its
// samples takes the nearer of the two by value. A strip of one row of places that truly differs so
// cannot be told from that. `value`: log E of each sample. Returns how many samples moved; labels
// keep their numbers, some of which may be empty then.
int dissolve_borders(const std::vector<Vec3>& places, const Eigen::VectorXd& value,
                     std::vector<int>& label);

}  // namespace hapsim
