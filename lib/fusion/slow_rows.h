// The slow forces of a recording, as they come to be known beside the fast one.
#pragma once

#include <map>
#include <vector>

#include "fusion/fuse_recordings.h"

namespace hapsim {

struct SlowRow {
  double t = 0, arrives = 0;
  Vec3 force = Vec3::Zero();
};
using SlowRows = std::map<int, std::vector<SlowRow>>;  // by press, in the order of arrival

// Of the presses of `fast`, which may have none. Error(kBadInput) as fuse() has it, or where the
// motions differ.
SlowRows slow_rows(const Recording& fast, const SlowSource& slow);

// Slow forces as they come, and so many times as seldom and as late: what is learned of them serves
// at any of these paces.
std::vector<SlowRows> paces_of(const SlowRows& rows);

}  // namespace hapsim
