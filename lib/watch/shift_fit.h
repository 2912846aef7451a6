// How far a body has moved, from presses on it.
#pragma once

#include "watch/corrected_model.h"
#include "watch/usual_stiffness.h"

namespace hapsim {

struct ShiftFit {
  Vec3 shift = Vec3::Zero();      // in all [m]
  Vec3 std_error = Vec3::Zero();  // large where no press tells [m]
  double stiffness = 1;           // in all
  double force_error = 0;  // that this leaves, over the usual size of a residual component; rms
  double sum_of_squares = 0;
  std::vector<double> gaps;  // that each press shows: the surface lies so much further out [m]
};

// The shift that explains the window best, with a factor of the stiffness as `usual` knows it, the
// rest of `known` as it is. Every press has a gap and an error of its force beside it, as large as
// those of surface and model usually are (usual.share, in each direction), so that presses count as
// presses and not as samples. One press tells a shift along its normal alone, and one that touches
// no more only that the body is out of reach: `everywhere` begins with a grid about the shift
// `about`, otherwise the search goes on from there. Ways that no press tells stay small.
ShiftFit fit_shift(const PreparedBody& body, const SurfaceOffsets& offsets,
                   const std::vector<WatchedSample>& window, const Correction& known,
                   const Vec3& about, const UsualStiffness& usual, bool everywhere);

}  // namespace hapsim
