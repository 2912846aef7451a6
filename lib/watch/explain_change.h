// Which change explains what a stream shows since.
#pragma once

#include <string>

#include "watch/corrected_model.h"
#include "watch/usual_stiffness.h"

namespace hapsim {

enum class Change { kNone, kMoved, kGone, kMaterial, kSensor, kUnexplained };
std::string change_name(Change change);  // "moved", "gone", "material", "sensor", "unexplained"

struct Explanation {
  Change change = Change::kUnexplained;
  Correction correction;            // in all
  Vec3 shift_error = Vec3::Zero();  // of a body that has moved: standard error [m]
  double force_error = 0;           // that this leaves, see ShiftFit
  double chi = 0;                   // of a residual component
  double margin = 0;  // of chi-square, by independent samples, to the next best hypothesis
  double error = 0;   // root mean square of a residual component [N]
};

// The samples since a change, explained by each hypothesis: body moved, gone, all moduli changed
// (by one factor, or those that relax and their times each by their own),
// sensor's zero changed, from what was `known` before; the one with the least information criterion
// is believed. The statistics are those of the diagnosis of few presses (estimate/information.h).
// What is tried is not: the catalogue's effects are solved for with finite elements and over all
// their starts, in seconds; here a prepared body is corrected in place, in tens of milliseconds,
// and between two presses. kUnexplained where even the best leaves too much.
Explanation explain_change(const PreparedBody& body, const SurfaceOffsets& offsets,
                           const std::vector<WatchedSample>& window, const Correction& known,
                           const UsualStiffness& usual);
// The same of a material alone: all of it by one factor (a partial identification), or also what
// relaxes (a full one).
Explanation explain_material(const PreparedBody& body, const SurfaceOffsets& offsets,
                             const std::vector<WatchedSample>& window, const Correction& known);

}  // namespace hapsim
