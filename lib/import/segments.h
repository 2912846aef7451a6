// Which rows of a recording belong to one press.
#pragma once

#include <string>
#include <vector>

#include "import/samples.h"

namespace hapsim {

struct Segment {
  std::vector<int> rows;  // of the table, in order of time
  int recording =
      0;  // continuous recording it was cut out of: same time, same place of the machine
  bool sliding = false;  // the tool slides over the surface: no press
};

// How presses are told apart: `by` is "" (automatic), "none" (each recording is one press), "force"
// (where the force returns to zero) or "jump" (where the tip moves sideways). Automatic: by the
// columns that name a press; else by repeated headers, time that starts again, a new contact point,
// a restarted count of samples, jumps of the tip, and returns of the force to zero. Rows out of
// order are sorted by time, rows with a time that was already there are left out (counted in the
// notes). A recording whose tool slides over the surface is not cut by jumps and returns of the
// force unless `by` says so.
std::vector<Segment> find_segments(const Samples& samples, const std::string& by,
                                   const std::string& file, Notes& notes);

// Whether the bare positions stand still within presses, so they are contact points and not tips.
bool positions_stand_still(const Samples& samples);

}  // namespace hapsim
