// Where the tip of a tool was in time: what a live simulation follows, without asking for presses.
#pragma once

#include <ostream>
#include <vector>

#include "cli/summary.h"
#include "import/import.h"

namespace hapsim {

struct TipMotion {
  Metadata metadata;      // source, and what was told of the tool
  std::vector<double> t;  // [s], never falling
  std::vector<Vec3> tip;  // [m]
  Notes notes;
};

// Of the columns that import_recording() takes for time and tip; forces are not needed. Rows whose
// time runs backwards are sorted in. Of a ball's centres (options.tip == "centre", which needs
// options.tool_radius) the tip is a radius along options.direction. Error(kBadInput): there is no
// time or no position; options.units.length is not the unit that the columns name; without
// options.units.trusted, a position beyond 10 m or a motion over more than 1.5 m.
TipMotion tip_motion(const RawTable& table, const ImportOptions& options);

// "# tool_radius: 0.004", then t,x,y,z, as hs-simulate --live reads it.
void write_tip_motion(std::ostream& out, const TipMotion& motion);

Summary tip_motion_summary(const TipMotion& motion);

}  // namespace hapsim
