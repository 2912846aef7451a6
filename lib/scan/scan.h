// A scan as it was read, whatever its source: points and what is known of each.
#pragma once

#include <string>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct Scan {
  PointCloud cloud;                     // [m]
  std::vector<Vec3> to_sensor;          // unit, from the point to what saw it; empty: not known
  std::vector<int> zone;                // index into zone_names; empty: one zone
  std::vector<std::string> zone_names;  // in order of first appearance
  std::vector<double> touch_force;      // that the probe pressed with [N]; empty: not known
  std::vector<std::string> notes;       // what was assumed or left out, for people
};

// Keeps the points at `index`, in that order, with all that is known of them.
Scan pick(const Scan& scan, const std::vector<int>& index);

// Appends `more`, whose points become a zone of their own (or keep theirs, renamed when taken).
void append_zone(Scan& scan, const Scan& more, const std::string& zone);

}  // namespace hapsim
